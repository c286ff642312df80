// SPDX-License-Identifier: Apache-2.0
#include "tools/world/vehicle.hpp"

namespace warren::world {

Vehicle husky() {
  return {.name = "husky",
          .wheelbase_m = 0.512,
          .track_m = 0.555,
          .wheel_radius_m = 0.165,
          .body_length_m = 0.86,
          .body_width_m = 0.67,
          .clearance_m = 0.13,
          .height_m = 0.85,
          .max_pitch_rad = 0.52,
          .max_roll_rad = 0.44,
          .max_step_m = 0.15,
          .max_warp_m = 0.08,
          .sensor_height_m = 0.75};
}

Vehicle spot() {
  return {.name = "spot",
          .wheelbase_m = 0.65,
          .track_m = 0.35,
          .wheel_radius_m = 0.03,
          .body_length_m = 1.0,
          .body_width_m = 0.45,
          .clearance_m = 0.40,
          .height_m = 0.90,
          .max_pitch_rad = 0.70,
          .max_roll_rad = 0.44,
          .max_step_m = 0.30,
          .max_warp_m = 0.15,
          .sensor_height_m = 0.80};
}

std::optional<Vehicle> vehicle_of(std::string_view name) {
  for (Vehicle& vehicle : std::vector{husky(), spot()})
    if (vehicle.name == name) return vehicle;
  return std::nullopt;
}

std::vector<std::string> vehicle_names() { return {husky().name, spot().name}; }

}  // namespace warren::world
