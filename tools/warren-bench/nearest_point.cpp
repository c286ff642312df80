// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/nearest_point.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

namespace warren {

struct NearestPoint::Tree {
  pcl::KdTreeFLANN<pcl::PointXYZ> index;
};

NearestPoint::NearestPoint(std::span<const Eigen::Vector3f> points) {
  if (points.empty()) return;
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(points.size());
  for (const Eigen::Vector3f& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  tree_ = std::make_unique<Tree>();
  tree_->index.setInputCloud(cloud);
}

NearestPoint::~NearestPoint() = default;

float NearestPoint::distance_m(const Eigen::Vector3f& from) const {
  if (!tree_) return std::numeric_limits<float>::infinity();
  std::vector<int> indices(1);
  std::vector<float> squared(1);
  tree_->index.nearestKSearch({from.x(), from.y(), from.z()}, 1, indices, squared);
  return std::sqrt(squared.front());
}

}  // namespace warren
