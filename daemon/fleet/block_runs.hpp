// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "core/layer/code_block.hpp"

namespace warren {

// In Morton order.
using BlockVoxels = std::array<VoxelCode, kVoxelsPerBlock>;

inline constexpr std::size_t kBlockRunsMax = kVoxelsPerBlock;  // bytes

// Appends a block's codes, x fastest, then y, in runs that anybody can read in a loop of five
// lines: a byte below 128 is one voxel's code; one from 128 on is that code plus 128, and the byte
// after it says how many voxels have it: n + 2, or with n = 255 all that are left of the block.
void append_runs(const BlockVoxels& voxels, std::string& bytes);

}  // namespace warren
