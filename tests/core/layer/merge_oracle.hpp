// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "core/layer/merge_map.hpp"

namespace warren::test {

using LayerVoxels = std::map<VoxelKey, VoxelCode>;

// A merged map written out voxel by voxel.
using MergedVoxels = std::map<VoxelKey, std::pair<std::uint8_t, MergeSourceId>>;
MergedVoxels voxels_of(MergeMap& map, const KeyBox& box = {});

// A layer as the oracle knows it.
struct OracleLayer {
  bool counts = true;
  double resolution_m = 0.1;
  Eigen::Isometry3d T_merge_layer = Eigen::Isometry3d::Identity();
  LayerVoxels voxels;
  std::map<BlockKey, std::int64_t> changed_ns;  // by block; 0 if not told
};
using OracleLayers = std::map<MergeSourceId, OracleLayer>;

// The merge from its definition, one voxel after the other.
MergedVoxels merged_by_definition(const OracleLayers& layers, double resolution_m, MergeRule rule);

}  // namespace warren::test
