// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/triangle_box.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace warren::world {
namespace {

// Both shadows on an axis: the box's is symmetric, its centre being the origin.
bool separates(const Eigen::Vector3d& axis, const std::array<Eigen::Vector3d, 3>& corners,
               double half_m) {
  const double reach = half_m * axis.cwiseAbs().sum();
  const auto [low, high] =
      std::minmax({axis.dot(corners[0]), axis.dot(corners[1]), axis.dot(corners[2])});
  return low > reach || high < -reach;
}

}  // namespace

bool triangle_touches_box(const std::array<Eigen::Vector3d, 3>& triangle,
                          const Eigen::Vector3d& box_centre, double half_m) {
  const std::array<Eigen::Vector3d, 3> corners{triangle[0] - box_centre, triangle[1] - box_centre,
                                               triangle[2] - box_centre};
  for (int axis = 0; axis < 3; ++axis)
    if (separates(Eigen::Vector3d::Unit(axis), corners, half_m)) return false;
  const std::array<Eigen::Vector3d, 3> edges{corners[1] - corners[0], corners[2] - corners[1],
                                             corners[0] - corners[2]};
  if (separates(edges[0].cross(edges[1]), corners, half_m)) return false;
  for (const Eigen::Vector3d& edge : edges)
    for (int axis = 0; axis < 3; ++axis)
      if (separates(Eigen::Vector3d::Unit(axis).cross(edge), corners, half_m)) return false;
  return true;
}

}  // namespace warren::world
