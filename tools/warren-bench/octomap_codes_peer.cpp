// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/octomap_codes_peer.hpp"

#include <octomap/OcTree.h>

#include "core/voxel/morton.hpp"

namespace warren {
namespace {

octomap::OcTreeKey octomap_key(const VoxelKey& key) {
  return {static_cast<octomap::key_type>(key.x - kKeyMin),
          static_cast<octomap::key_type>(key.y - kKeyMin),
          static_cast<octomap::key_type>(key.z - kKeyMin)};
}

}  // namespace

struct OctomapCodesPeer::Tree : octomap::OcTree {
  using octomap::OcTree::OcTree;
};

OctomapCodesPeer::OctomapCodesPeer(double resolution_m, bool lazy_eval)
    : tree_(std::make_unique<Tree>(resolution_m)), lazy_eval_(lazy_eval) {}

OctomapCodesPeer::~OctomapCodesPeer() = default;

void OctomapCodesPeer::insert(std::span<const ChangedVoxel> voxels) {
  const float occupied = tree_->getClampingThresMaxLog();
  const float free = tree_->getClampingThresMinLog();
  for (const ChangedVoxel& voxel : voxels) {
    const bool is_occupied = voxel.code.state() == VoxelState::kOccupied;
    tree_->setNodeValue(octomap_key(key_of_morton(voxel.morton)), is_occupied ? occupied : free,
                        lazy_eval_);
  }
}

void OctomapCodesPeer::finish() {
  if (!lazy_eval_) return;
  tree_->updateInnerOccupancy();
  tree_->prune();
}

VoxelState OctomapCodesPeer::search(const VoxelKey& key) const {
  const octomap::OcTreeNode* const node = tree_->search(octomap_key(key));
  if (node == nullptr) return VoxelState::kUnknown;
  return tree_->isNodeOccupied(node) ? VoxelState::kOccupied : VoxelState::kFree;
}

}  // namespace warren
