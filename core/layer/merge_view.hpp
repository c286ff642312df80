// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/layer/merge_map.hpp"
#include "core/terrain/terrain_view.hpp"

namespace warren {

// The merge-map as planners read it. A cost is its bin's upper edge: never below what was measured.
class MergeView : public TerrainView {
 public:
  // Keeps a reference; reading derives blocks.
  explicit MergeView(MergeMap& map) : map_(map) {}

  const Lattice& lattice() const override { return map_.lattice(); }
  VoxelState state(const VoxelKey& key) const override { return map_.voxel(key).code.state(); }
  std::optional<float> cost(const VoxelKey& key) const override {
    return decode_cost(map_.voxel(key).code.cost());
  }
  bool is_stair(const VoxelKey& key) const override { return map_.voxel(key).code.stair(); }

 private:
  MergeMap& map_;
};

}  // namespace warren
