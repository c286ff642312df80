// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace warren {

// How a layer lies apart from where its pose puts it: turned about the vertical through its origin,
// then shifted.
struct LayerShift {
  static constexpr double kYawMost_rad = 1000.0;  // either way

  Eigen::Vector3d shift_fleet_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

inline Eigen::Isometry3d shifted(const Eigen::Isometry3d& T_fleet_layer, const LayerShift& shift) {
  Eigen::Isometry3d moved = T_fleet_layer;
  moved.linear() = Eigen::AngleAxisd(shift.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                   T_fleet_layer.linear();
  moved.translation() += shift.shift_fleet_m;
  return moved;
}

}  // namespace warren
