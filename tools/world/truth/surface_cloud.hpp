// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tools/world/random.hpp"
#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

struct SurfaceSample {
  Eigen::Vector3f position;
  Surface surface = Surface::kRock;
};

// Points all over a mesh, one per `spacing_m` squared of its area: as many on a triangle as it has
// area, whatever the triangles' sizes.
std::vector<SurfaceSample> sample_surface(const TriangleMesh& mesh, double spacing_m,
                                          Random random);

}  // namespace warren::world
