// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/exchange/byte_fields.hpp"
#include "core/layer/code_block.hpp"

namespace warren {

// The mask of a block's voxels as bytes: two bits per word say all clear, all set, or mixed; of a
// mixed word two bits per byte say the same. 2 to 82 bytes, and no model to train: what a store
// wrote is read by every later release.
void write_mask(const VoxelMask& mask, ByteWriter& writer);
// Nothing if the bytes are none that write_mask() makes.
std::optional<VoxelMask> read_mask(ByteReader& reader);

}  // namespace warren
