// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "core/voxel/self_map.hpp"

namespace warren {

// A cube of 2^level voxels per edge.
struct OctreeLeaf {
  VoxelKey low;  // the corner with the smallest keys
  int level = 0;
  VoxelState state = VoxelState::kUnknown;
};

// Read-only octree over a self-map, pruned: eight equal children are one leaf. It is computed while
// it is walked; nothing is stored. Level 0 is a voxel, level 16 the whole key space.
class OctreeView {
 public:
  static constexpr int kRootLevel = 16;

  explicit OctreeView(const SelfMap& map) : map_(&map) {}

  // State of the cube of 2^level voxels around a voxel, as OctoMap's inner nodes have it: occupied
  // if any voxel is, else free if any is, else unknown.
  VoxelState state(const VoxelKey& key, int level) const;

  // Visits the known leaves of the pruned tree in Morton order, none smaller than 2^min_level
  // voxels: what is mixed at that level has the state above. Equality is of states, not log-odds.
  void for_each_leaf(int min_level, const std::function<void(const OctreeLeaf&)>& visit) const;

 private:
  const SelfMap* map_;
};

}  // namespace warren
