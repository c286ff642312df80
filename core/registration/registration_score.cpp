// SPDX-License-Identifier: Apache-2.0
#include "core/registration/registration_score.hpp"

#include <cmath>

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

namespace warren {

struct RegistrationScorer::Tree {
  pcl::KdTreeFLANN<pcl::PointXYZ> index;
};

RegistrationScorer::RegistrationScorer(const Cloud& fixed, double tolerance_m)
    : tree_(std::make_unique<Tree>()), tolerance_m_(tolerance_m) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(fixed.size());
  for (const Eigen::Vector3d& point : fixed) {
    const Eigen::Vector3f p = point.cast<float>();
    cloud->push_back({p.x(), p.y(), p.z()});
  }
  tree_->index.setInputCloud(cloud);
}

RegistrationScorer::~RegistrationScorer() = default;

RegistrationScore RegistrationScorer::score(const Cloud& moving,
                                            const Eigen::Isometry3d& motion) const {
  RegistrationScore score;
  double squares = 0.0;
  std::vector<int> index(1);
  std::vector<float> squared(1);
  for (const Eigen::Vector3d& point : moving) {
    const Eigen::Vector3f p = (motion * point).cast<float>();
    if (tree_->index.nearestKSearch({p.x(), p.y(), p.z()}, 1, index, squared) == 0) continue;
    const double distance_m = std::sqrt(static_cast<double>(squared.front()));
    if (distance_m > RegistrationScore::kNear_m) continue;
    ++score.near;
    if (distance_m > tolerance_m_) continue;
    ++score.fitting;
    squares += distance_m * distance_m;
  }
  if (score.fitting > 0) score.rms_m = std::sqrt(squares / static_cast<double>(score.fitting));
  return score;
}

}  // namespace warren
