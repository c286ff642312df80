// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/rivals/diff_tree.hpp"

namespace warren {

// The predecessor's diff-map (paper Eq. 7-9): an octree of the changed voxels, depth first, in
// which every inner node tells of its eight children in 7 bits each, those that do not exist
// included: 2 of occupancy {unknown, free, occupied, child}, 4 of cost, 1 of stair. One diff-map is
// one message. "As flown" is Pruning::kNone, which gives the size that was measured of the
// predecessor's own diff-maps; "ideally pruned" is Pruning::kEqualCodes.
std::vector<std::uint8_t> encode_octree7(ChangedVoxels voxels, Pruning pruning);

// The voxels again. Precondition: `bytes` are what encode_octree7() made.
std::vector<ChangedVoxel> decode_octree7(std::span<const std::uint8_t> bytes);

}  // namespace warren
