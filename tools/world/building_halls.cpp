// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "tools/world/building.hpp"
#include "tools/world/cables.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {

// From corridor to corridor, with wide doors and what robots train on: ramps of 5 to 45 degrees and
// stepfields below, a hole in the floor above.
void Building::build_hall(int level, int bay) {
  constexpr int kWayIn = 1;
  const double x = x_of(bay);
  const double z = floor_of(level);
  const double way_x = x + 3.0;
  const auto carve = [this](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    plan_.carve({low, high});
  };
  carve({x, 1.25, z}, {x + kBay_m - kWall_m, 11.5, z + kRoom_m});
  carve({way_x - 1.0, 1.0, z}, {way_x + 1.0, 11.75, z + 2.5});
  network_.join(corridor_node(level, 0, bay, kWayIn), corridor_node(level, 1, bay, kWayIn),
                Air::kNone);
  for (const double y : {2.0, 8.0})
    objects_.append(stepfield({.highest_m = random_.uniform(0.2, 0.5)}, random_),
                    upright({x + 0.2, y, z}, 0.0));
  if (level == 1) {
    const double hole_y = 3.0 + kCell_m * random_.below(16);
    carve({x + 5.0, hole_y, 0.0}, {x + 6.5, hole_y + 1.5, z + kRoom_m});
    return;
  }
  int place = 0;
  for (const double angle_deg : {5.0, 15.0, 25.0, 35.0, 45.0}) {
    const Ramp ramp{.angle_rad = angle_deg * std::numbers::pi / 180.0, .height_m = 0.28};
    objects_.append(wedge(ramp), upright({x + 4.3, 2.4 + 1.9 * place++, z}, 0.0));
  }
}

// Two cables along the wall below the ceiling, from hook to hook.
void Building::hang_cables(int level, int corridor, int bay) {
  const double y = kCorridorY[static_cast<std::size_t>(corridor)] + kHalfCorridor_m - 0.1;
  const double z = floor_of(level) + kRoom_m - 0.15;
  for (int hook = 0; hook < 2; ++hook) {
    for (const double aside : {0.0, 0.08}) {
      const Eigen::Vector3d from(x_of(bay) + 4.0 * hook, y - aside, z);
      objects_.append(cable({.from = from,
                             .to = from + 4.0 * Eigen::Vector3d::UnitX(),
                             .sag_m = random_.uniform(0.1, 0.4),
                             .radius_m = 0.012}));
    }
  }
}

}  // namespace warren::world
