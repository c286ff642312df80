// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/voxel/point.hpp"

namespace warren {

struct PeerPlane {
  Point3f normal;  // NaN where PCL finds none
  float curvature = 0.0F;
};

// Debian's PCL doing the paper's preprocessing, one thread: the oracle of the tests and the peer of
// the benchmarks.
class PclTerrainPeer {
 public:
  // A cloud in PCL's own type, made outside of any timer.
  struct Cloud;
  using CloudPtr = std::shared_ptr<const Cloud>;
  static CloudPtr make_cloud(std::span<const Point3f> points);
  static std::vector<Point3f> points_of(const Cloud& cloud);
  static std::size_t size_of(const Cloud& cloud);

  // pcl::VoxelGrid
  static CloudPtr reduce(const Cloud& cloud, float cell_m);
  // pcl::NormalEstimation with the k nearest
  static std::vector<PeerPlane> fit_planes(const Cloud& cloud, int k);
};

}  // namespace warren
