// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include <octomap/OcTree.h>

#include "core/voxel/self_map.hpp"

namespace warren::test {

using States = std::map<VoxelKey, VoxelState>;

// Of every voxel that the tree knows, which it is expanded for.
inline States states_of(octomap::OcTree& tree) {
  tree.expand();
  States states;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    const octomap::OcTreeKey key = leaf.getKey();
    states[{key[0] + kKeyMin, key[1] + kKeyMin, key[2] + kKeyMin}] =
        tree.isNodeOccupied(*leaf) ? VoxelState::kOccupied : VoxelState::kFree;
  }
  return states;
}

}  // namespace warren::test
