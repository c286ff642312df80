// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace warren::world {

// A rigid box on four wheels or feet. Its base frame lies on the ground below its middle, x ahead.
struct Vehicle {
  std::string name;
  double wheelbase_m = 0.0;     // between front and rear contacts
  double track_m = 0.0;         // between left and right contacts
  double wheel_radius_m = 0.0;  // what bridges cracks; a foot's is small
  double body_length_m = 0.0;
  double body_width_m = 0.0;
  double clearance_m = 0.0;  // from the ground to the belly
  double height_m = 0.0;     // to the highest part, sensor included
  double max_pitch_rad = 0.0;
  double max_roll_rad = 0.0;
  double max_step_m = 0.0;
  double max_warp_m = 0.0;       // by how much contacts may deviate from one plane
  double sensor_height_m = 0.0;  // above the ground
};

// A wheeled robot like Clearpath's Husky, and a legged one like Boston Dynamics' Spot: sizes from
// their data sheets, limits about what the SubT teams dared.
Vehicle husky();
Vehicle spot();
std::optional<Vehicle> vehicle_of(std::string_view name);
std::vector<std::string> vehicle_names();

}  // namespace warren::world
