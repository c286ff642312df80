// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tools/world/node_grid.hpp"
#include "tools/world/random.hpp"
#include "tools/world/world.hpp"

namespace warren::world {

struct Litter {
  double boulder_share = 0.12;  // of the nodes
  double boulder_min_m = 0.25;  // radius
  double boulder_max_m = 0.8;
  double rubble_share = 0.05;
  double free_m = 0.5;  // to either side of the paths
};
// The height of the ground below a point.
using Ground = std::function<double(const Eigen::Vector3d&)>;

// Boulders and rubble on the floor beside the paths, never on them.
void scatter_litter(World& world, const NodeGrid& grid, const Ground& ground, const Litter& litter,
                    Random& random);

}  // namespace warren::world
