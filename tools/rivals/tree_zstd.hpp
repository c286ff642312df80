// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/rivals/diff_tree.hpp"

namespace warren {

inline constexpr int kZstdLevel = 19;

// A leaner rival: the pruned octree, depth first, in 2 bits per child {unchanged, free, occupied,
// child}; behind it the cost and the stair of every occupied leaf in 5 bits.
std::vector<std::uint8_t> encode_tree(ChangedVoxels voxels);

// The voxels again. Precondition: `bytes` are what encode_tree() made.
std::vector<ChangedVoxel> decode_tree(std::span<const std::uint8_t> bytes);

// A stream through zstd at kZstdLevel.
std::vector<std::uint8_t> compress_zstd(std::span<const std::uint8_t> bytes);

// Precondition: `bytes` are what compress_zstd() made.
std::vector<std::uint8_t> decompress_zstd(std::span<const std::uint8_t> bytes);

}  // namespace warren
