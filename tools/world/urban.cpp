// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tools/world/building.hpp"
#include "tools/world/presets.hpp"

namespace warren::world {
namespace {

constexpr double kUrbanLength_m = 300.0;
// What a bay adds on both levels, and what the stairwells do.
constexpr double kBayWays_m = 58.0;
constexpr double kStairWays_m = 45.0;

}  // namespace

World make_urban(const WorldSpec& spec) {
  const double length_m = spec.length_m > 0.0 ? spec.length_m : kUrbanLength_m;
  const int bays =
      std::max(2, static_cast<int>(std::lround((length_m - kStairWays_m) / kBayWays_m)));
  Building building(bays, Random(spec.seed));
  building.build();
  World world;
  world.mesh = building.mesh();
  world.stairways = building.stairways();
  world.passages = building.passages();
  world.start = world.passages.nodes[0].position;
  world.start_yaw_rad = 0.0;
  return world;
}

}  // namespace warren::world
