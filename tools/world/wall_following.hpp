// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/world/caster.hpp"
#include "tools/world/route.hpp"
#include "tools/world/vehicle.hpp"

namespace warren::world {

// A way through a world whose passages nobody knows (an imported mesh): keeps the wall at the right
// hand, feeling with rays and with the vehicle's own body, until it is back, stuck, or has gone
// `steps` steps.
struct WallFollowing {
  double step_m = 0.25;
  double room_m = 1.0;  // free way that it wants ahead
  std::uint32_t steps = 4000;
};
Route follow_wall(const Caster& caster, const Vehicle& vehicle, const Eigen::Vector3d& start,
                  double start_yaw_rad, const WallFollowing& config = {});

}  // namespace warren::world
