// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

namespace warren {

// How far the nearest of a set of points is (PCL's k-d tree).
class NearestPoint {
 public:
  explicit NearestPoint(std::span<const Eigen::Vector3f> points);
  ~NearestPoint();

  // Metres; infinity when there are no points.
  float distance_m(const Eigen::Vector3f& from) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace warren
