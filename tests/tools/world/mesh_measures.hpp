// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/world/triangle_mesh.hpp"

namespace warren::test {

// By the divergence theorem; positive if the triangles face outward.
double volume_m3(const world::TriangleMesh& mesh);

// Whether every edge of indices is used as often in one direction as in the other.
bool is_closed(const world::TriangleMesh& mesh);
// The same, vertices in the same place counting as one.
bool is_closed_in_space(const world::TriangleMesh& mesh);

// Whether two meshes are the same to the last byte.
bool is_same(const world::TriangleMesh& a, const world::TriangleMesh& b);

Eigen::Vector3d normal_of(const world::TriangleMesh& mesh, std::size_t triangle);

}  // namespace warren::test
