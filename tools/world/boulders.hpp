// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/world/random.hpp"
#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

struct Boulder {
  double radius_m = 0.5;
  double roughness = 0.25;  // share of the radius
  int refinements = 2;      // of the icosahedron: 20 * 4^n triangles
  Surface surface = Surface::kBoulder;
};
// A rough sphere about the origin, flattened a little.
TriangleMesh boulder(const Boulder& settings, Random& random);

struct RubblePile {
  double radius_m = 0.8;
  double height_m = 0.4;
  int stones = 40;
};
// A cone-like heap of small stones on z = 0.
TriangleMesh rubble_pile(const RubblePile& settings, Random& random);

}  // namespace warren::world
