// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/layer/claim.hpp"
#include "core/layer/code_block.hpp"

namespace warren {

// The codes of one block as they are now; empty if nothing is known of it any more.
struct CodedBlock {
  BlockOrdinal block = 0;
  CodeBlock codes;
};

}  // namespace warren
