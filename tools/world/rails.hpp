// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

struct Rails {
  double gauge_m = 0.6;  // mine track
  double rail_width_m = 0.05;
  double rail_height_m = 0.08;
  double sleeper_every_m = 0.7;
  double sleeper_length_m = 1.0;
  double sleeper_width_m = 0.12;
  double sleeper_height_m = 0.06;  // above the floor
};
// Two rails on sleepers along a line of floor points, at least two.
TriangleMesh rails(const std::vector<Eigen::Vector3d>& line, const Rails& settings);

}  // namespace warren::world
