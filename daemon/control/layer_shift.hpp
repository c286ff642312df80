// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "core/layer/layer_pose.hpp"

namespace warren {

// How a layer lies apart from where its pose puts it: turned about the vertical through its origin,
// then shifted.
struct LayerShift {
  static constexpr double kYawMost_rad = 1000.0;  // either way

  Eigen::Vector3d shift_fleet_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;

  // Finite, and no further than any layer may lie.
  bool is_within_reach() const {
    return shift_fleet_m.allFinite() &&
           shift_fleet_m.cwiseAbs().maxCoeff() <= LayerPose::kReach_m &&
           std::abs(yaw_rad) <= kYawMost_rad;
  }
};

inline Eigen::Isometry3d shifted(const Eigen::Isometry3d& T_fleet_layer, const LayerShift& shift) {
  Eigen::Isometry3d moved = T_fleet_layer;
  moved.linear() = Eigen::AngleAxisd(shift.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                   T_fleet_layer.linear();
  moved.translation() += shift.shift_fleet_m;
  return moved;
}

}  // namespace warren
