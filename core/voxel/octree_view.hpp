// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "core/voxel/self_map.hpp"

namespace warren {

// A cube of 2^level voxels per edge whose known voxels... see OctreeView.
struct OctreeLeaf {
  VoxelKey low;  // corner with the smallest key
  int level = 0; // edge = 2^level voxels
  VoxelState state = VoxelState::kUnknown;
};

// Read-only octree over a self-map, pruned: eight equal children are one leaf. It is computed while
// it is walked; nothing is stored. Level 0 is a voxel, level 16 the whole key space.
class OctreeView {
 public:
  explicit OctreeView(const SelfMap& map) : map_(&map) {}

  // State of the cube of 2^level voxels that contains the key, as OctoMap's inner nodes: occupied
  // if any voxel is, else free if any is, else unknown.
  VoxelState state(const VoxelKey& key, int level) const;

  // Visits the known leaves (free or occupied) of the pruned tree, none smaller than 2^min_level
  // voxels: cubes that are mixed at that level have the state above.
  void for_each_leaf(int min_level, const std::function<void(const OctreeLeaf&)>& visit) const;

 private:
  const SelfMap* map_;
};

}  // namespace warren
