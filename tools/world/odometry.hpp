// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "tools/world/random.hpp"

namespace warren::world {

// How far a robot's belief about its pose is from the truth. All zero: it knows the truth.
struct OdometryErrors {
  double scale = 0.0;                // travelled ways are measured as (1 + scale) of themselves
  double yaw_drift_rad_m = 0.0;      // per metre
  double yaw_walk_rad_sqrt_m = 0.0;  // standard deviation of a random walk, per sqrt(m)
  double z_drift_m_m = 0.0;          // per metre
  double noise_m = 0.0;              // standard deviation, independent every 0.1 s
  double noise_rad = 0.0;            // of yaw, likewise
  struct Jump {                      // of the map frame below the robot, as a SLAM correction makes
    double time_s = 0.0;
    Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
    double turn_rad = 0.0;  // about the place where the robot is
  };
  std::vector<Jump> jumps{};  // by time
};

enum class MapFrame : std::uint8_t {
  kLevelled,   // the start pose with its z axis against gravity
  kAsStarted,  // the start pose itself
};

// What a robot believes: T_map_base by time. Roll and pitch come from gravity and do not drift.
class Odometry {
 public:
  using Truth = std::function<Eigen::Isometry3d(double time_s)>;  // T_world_base
  struct Period {
    double start_s = 0.0;
    double end_s = 0.0;
  };
  Odometry(const Truth& truth, const Period& period, const OdometryErrors& errors, MapFrame frame,
           Random random);

  Eigen::Isometry3d T_map_base(double time_s) const;
  // Where the map frame was at the start, and where it would still be without errors.
  const Eigen::Isometry3d& T_world_map() const { return T_world_map_; }
  // Unit, down.
  Eigen::Vector3d gravity_map() const { return -T_world_map_.linear().row(2).transpose(); }

 private:
  // The belief is the truth, moved: yaw and place alone are wrong.
  struct Deviation {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world, believed minus true
    double yaw_rad = 0.0;
  };
  Deviation deviation_at(double time_s) const;
  Eigen::Isometry3d without_jumps(double time_s) const;  // T_world_base as believed
  void add_jump(const OdometryErrors::Jump& jump);
  Eigen::Isometry3d jumped(double time_s) const;

  Truth truth_;
  double start_s_;
  Eigen::Isometry3d T_world_map_;
  std::vector<Deviation> deviations_;  // at even steps from the start
  struct Moved {
    double from_s;
    Eigen::Isometry3d by;  // all jumps up to this one, in the world frame
  };
  std::vector<Moved> moved_;
};

}  // namespace warren::world
