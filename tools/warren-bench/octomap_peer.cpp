// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/octomap_peer.hpp"

#include <octomap/OcTree.h>

namespace warren {

struct OctomapPeer::Tree : octomap::OcTree {
  using octomap::OcTree::OcTree;
};

struct OctomapPeer::Cloud {
  octomap::Pointcloud points;
  octomap::point3d origin;
  double max_range_m = -1.0;  // OctoMap's "no limit"
};

OctomapPeer::OctomapPeer(const SelfMapConfig& config, bool lazy_eval)
    : tree_(std::make_unique<Tree>(config.resolution_m)),
      discretize_(config.one_ray_per_end_voxel),
      lazy_eval_(lazy_eval) {
  tree_->setProbHit(config.sensor_model.hit);
  tree_->setProbMiss(config.sensor_model.miss);
  tree_->setClampingThresMin(config.sensor_model.minimum);
  tree_->setClampingThresMax(config.sensor_model.maximum);
}

OctomapPeer::~OctomapPeer() = default;
OctomapPeer::OctomapPeer(OctomapPeer&&) noexcept = default;

std::shared_ptr<const OctomapPeer::Cloud> OctomapPeer::make_cloud(const LayerScan& scan) {
  auto cloud = std::make_shared<Cloud>();
  cloud->origin = {scan.origin_layer.x, scan.origin_layer.y, scan.origin_layer.z};
  cloud->max_range_m = scan.max_range_m.value_or(-1.0);
  cloud->points.reserve(scan.points_layer.size() + scan.carved_ends_layer.size());
  for (const Point3f& p : scan.points_layer) cloud->points.push_back(p.x, p.y, p.z);
  for (const Point3f& p : scan.carved_ends_layer) cloud->points.push_back(p.x, p.y, p.z);
  return cloud;
}

void OctomapPeer::insert(const Cloud& cloud) {
  tree_->insertPointCloud(cloud.points, cloud.origin, cloud.max_range_m, lazy_eval_, discretize_);
}

void OctomapPeer::finish() {
  if (!lazy_eval_) return;
  tree_->updateInnerOccupancy();
  tree_->prune();
}

MapAgreement OctomapPeer::compare(const SelfMap& ours) const {
  MapAgreement agreement;
  const MapCounts counts = ours.counts();
  agreement.free_ours = counts.free;
  agreement.occupied_ours = counts.occupied;
  for (auto leaf = tree_->begin_leafs(), end = tree_->end_leafs(); leaf != end; ++leaf) {
    const bool occupied = tree_->isNodeOccupied(*leaf);
    const VoxelState wanted = occupied ? VoxelState::kOccupied : VoxelState::kFree;
    const int edge = 1 << (tree_->getTreeDepth() - leaf.getDepth());
    // A leaf's key names its centre; its corner is what the voxels are counted from.
    const octomap::OcTreeKey corner = leaf.getIndexKey();
    std::uint64_t both = 0;
    for (int i = 0; i < edge * edge * edge; ++i) {
      const VoxelKey key{static_cast<std::int32_t>(corner[0]) + i % edge + kKeyMin,
                         static_cast<std::int32_t>(corner[1]) + i / edge % edge + kKeyMin,
                         static_cast<std::int32_t>(corner[2]) + i / edge / edge + kKeyMin};
      if (ours.state(key) == wanted) ++both;
    }
    const auto volume = static_cast<std::uint64_t>(edge) * static_cast<std::uint64_t>(edge) *
                        static_cast<std::uint64_t>(edge);
    (occupied ? agreement.occupied_peer : agreement.free_peer) += volume;
    (occupied ? agreement.occupied_both : agreement.free_both) += both;
  }
  return agreement;
}

}  // namespace warren
