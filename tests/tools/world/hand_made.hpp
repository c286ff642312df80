// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/world/triangle_mesh.hpp"

namespace warren::world::test {

// A rectangle of ground, seen from above, at one height.
TriangleMesh flat(double half_m, double z_m = 0.0);
// Flat for x < 0, then rising at an angle.
TriangleMesh ramp(double angle_rad);
// Flat, with the ground higher by `height_m` for x > 0.
TriangleMesh step(double height_m);
// Flat, with a thin upright wall of a height across the way at x.
TriangleMesh wall(double x_m, double height_m);
// Ground with nothing for |x| < half_width_m.
TriangleMesh gap(double half_width_m);
// A closed room, seen from within: |x| <= half.x and so on.
TriangleMesh room(const Eigen::Vector3f& half);
// A ball of many small triangles about the origin, corners on the sphere.
TriangleMesh ball(float radius_m, int parts);
// Triangles anywhere in a cube.
TriangleMesh soup(int triangles, std::uint64_t seed);

}  // namespace warren::world::test
