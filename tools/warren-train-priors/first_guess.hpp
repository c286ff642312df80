// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/layer/diff_contexts.hpp"

namespace warren {

// What one would expect of each context before anything was counted: things look like their
// neighbours.
DiffPriors first_guess();

}  // namespace warren
