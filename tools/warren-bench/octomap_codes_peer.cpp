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

VoxelState state_of(const octomap::OcTree& tree, const octomap::OcTreeNode* node) {
  if (node == nullptr) return VoxelState::kUnknown;
  return tree.isNodeOccupied(node) ? VoxelState::kOccupied : VoxelState::kFree;
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
  return state_of(*tree_, tree_->search(octomap_key(key)));
}

void OctomapCodesPeer::search(std::span<const Point3f> points, std::span<VoxelState> states) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f& point = points[i];
    states[i] = state_of(*tree_, tree_->search(octomap::point3d(point.x, point.y, point.z)));
  }
}

}  // namespace warren
