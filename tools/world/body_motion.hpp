// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tools/world/caster.hpp"
#include "tools/world/route.hpp"
#include "tools/world/vehicle.hpp"

namespace warren::world {

struct Gait {
  double speed_m_s = 1.0;
  double turn_rad_s = 0.8;   // at most; turns on the spot where the route turns back
  double start_s = 0.0;      // stands still before
  double yaw_rad = 0.0;      // of one that has nowhere to go
  double smoothing_m = 0.5;  // standard deviation of the corners' and bumps' smoothing
};

// A vehicle on its way along a route, resting on the ground: pose by time, continuous. It stands at
// the first place before it starts and at the last one when it is through.
class BodyMotion {
 public:
  BodyMotion(const Caster& caster, const Vehicle& vehicle, const Route& route, const Gait& gait);

  Eigen::Isometry3d T_world_base(double time_s) const;
  double start_s() const { return samples_.front().time_s; }
  double end_s() const { return samples_.back().time_s; }

 private:
  struct Sample {
    double time_s = 0.0;
    Eigen::Vector3d position;
    Eigen::Quaterniond attitude;
  };
  std::vector<Sample> samples_;  // never empty, times strictly increasing
};

// The sensor above the vehicle's middle, looking down by `tilt_rad`.
Eigen::Isometry3d sensor_mount(const Vehicle& vehicle, double tilt_rad = 0.0);

}  // namespace warren::world
