// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "tools/world/random.hpp"
#include "tools/world/triangle_mesh.hpp"
#include "tools/world/world.hpp"

namespace warren::world {

// Closed solids in their own frame unless said otherwise.

TriangleMesh box(const Eigen::AlignedBox3d& extent, Surface surface);

struct Ramp {
  double angle_rad = 0.26;
  double height_m = 0.5;
  double width_m = 1.0;
  double length_m() const;  // on the ground
};
// A wedge that ascends along x from the origin, its middle on y = 0, standing on z = 0.
TriangleMesh wedge(const Ramp& ramp);

// The solid flight in the world frame: its nosings are exactly Stairway::edges(), and the tread
// behind the highest edge is part of it.
TriangleMesh solid_of(const Stairway& stairway);

struct Stepfield {
  int rows = 8;
  int columns = 8;
  double pitch_m = 0.2;
  double highest_m = 0.4;
};
// Square pillars of random height (ASTM E2828 style), the first corner at the origin.
TriangleMesh stepfield(const Stepfield& settings, Random& random);

// A pose that stands upright at a place.
Eigen::Isometry3d upright(const Eigen::Vector3d& position, double yaw_rad);

// From x towards y, of the way from one place to another in plan.
double heading_rad(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace warren::world
