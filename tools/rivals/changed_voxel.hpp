// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/layer/replica.hpp"

namespace warren {

// What every rival's encoding of a diff-map takes: voxels in Morton order of the whole key space
// (core/voxel/morton.hpp), none twice, none unknown, since the rivals cannot tell of that.
struct ChangedVoxel {
  std::uint64_t morton = 0;
  VoxelCode code;
  friend bool operator==(const ChangedVoxel&, const ChangedVoxel&) = default;
};

// The known voxels of `now` whose codes differ from the published ones.
std::vector<ChangedVoxel> changed_voxels(std::span<const CodedBlock> now, const Replica& published);

}  // namespace warren
