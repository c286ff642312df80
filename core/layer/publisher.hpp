// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/layer/coded_block.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

// The codes of one block of a self-map.
CodeBlock codes_of(const SelfMap& map, const BlockKey& key);

// What the owner of a self-map hands over at a tick: the blocks that changed after the scan
// numbered `cursor`, in no particular order, no block twice.
std::vector<CodedBlock> blocks_changed_since(const SelfMap& map, std::uint32_t cursor);

}  // namespace warren
