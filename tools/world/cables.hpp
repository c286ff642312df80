// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

struct Cable {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  double sag_m = 0.3;  // of the middle below the chord
  double radius_m = 0.02;
};
// A closed tube along the catenary between two points, straight without sag.
TriangleMesh cable(const Cable& settings);

// The tube itself, along any line of points.
TriangleMesh tube(const std::vector<Eigen::Vector3d>& line, double radius_m, int sides,
                  Surface surface);

struct Fence {
  Eigen::Vector3d from;  // on the floor
  Eigen::Vector3d to;
  double height_m = 2.0;
  double mesh_m = 0.15;  // between wires
  double wire_m = 0.003;
};
// Upright wire netting between two posts: the thin thing that maps lose.
TriangleMesh fence(const Fence& settings);

}  // namespace warren::world
