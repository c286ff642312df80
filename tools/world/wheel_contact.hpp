// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tools/world/caster.hpp"
#include "tools/world/vehicle.hpp"

namespace warren::world {

// A pose on the ground to try: `near_z_m` picks the floor where several lie above each other.
struct Stand {
  double x_m = 0.0;
  double y_m = 0.0;
  double near_z_m = 0.0;
  double yaw_rad = 0.0;
};

struct Contact {
  enum class Kind : std::uint8_t {
    kGround,
    kNothing,  // below the point is nothing
    kBlocked,  // something stands between the vehicle's middle and the point
  };
  Kind kind = Kind::kNothing;
  double z_m = 0.0;
};

// Finds what the wheels of a vehicle at a stand touch. A point is looked for from as high above the
// stand as the way there is free, so that a step is ground and a wall is none.
class WheelContacts {
 public:
  WheelContacts(const Caster& caster, const Vehicle& vehicle, const Stand& stand);

  // Height of the lowest point of a wheel that rests at (x, y) and rolls along the stand's yaw.
  Contact wheel(const Eigen::Vector2d& xy) const;
  // The ground itself.
  Contact ground(const Eigen::Vector2d& xy) const;

 private:
  void add_eye_if_in_air(double above_m);

  const Caster& caster_;
  Eigen::Vector2d middle_;
  Eigen::Vector2d ahead_;  // unit
  double near_z_m_;
  double wheel_radius_m_;
  double reach_m_;
  std::vector<double> eyes_m_;  // heights in the air above the middle to look from, highest first
};

}  // namespace warren::world
