// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "tools/world/caster.hpp"
#include "tools/world/simulation.hpp"

namespace warren::world {

// What a sensor could see, were its beams dense: by range and elevation in its own frame.
struct Field {
  double max_range_m = 20.0;
  double lowest_rad = -std::numbers::pi / 2.0;
  double highest_rad = std::numbers::pi / 2.0;
};
Field field_of(const LidarModel& lidar, double max_range_m);

// Where a robot's sensor was: T_world_sensor every `spacing_m` of its way.
std::vector<Eigen::Isometry3d> viewpoints_of(const Simulation& simulation, std::size_t robot,
                                             double spacing_m);

// Sees points from many places, nothing in between; surfaces within `skin_m` of the point do not
// count, so that a point on a surface can be seen. All it is given must outlive it.
class Sight {
 public:
  Sight(const Caster& caster, std::span<const Eigen::Isometry3d> viewpoints, const Field& field,
        double skin_m = 0.005);

  bool sees(const Eigen::Vector3f& point) const;

 private:
  struct Eye {
    Eigen::Vector3f position;
    Eigen::Vector3f up;  // of the sensor
  };
  bool sees_from(const Eye& eye, const Eigen::Vector3f& point) const;

  const Caster& caster_;
  std::vector<Eye> eyes_;
  float max_range_m_;
  float lowest_sine_;
  float highest_sine_;
  float skin_m_;
};

}  // namespace warren::world
