// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/world/hand_made.hpp"

#include <cmath>
#include <numbers>

#include "tools/world/random.hpp"

namespace warren::world::test {
namespace {

constexpr float kWide = 10.0F;

// Ground between two x, y wide, at a height that may differ at both ends.
void add_strip(TriangleMesh& mesh, const Eigen::Vector2f& from_xz, const Eigen::Vector2f& to_xz) {
  mesh.add_quad(
      {Eigen::Vector3f(from_xz.x(), -kWide, from_xz.y()),
       Eigen::Vector3f(to_xz.x(), -kWide, to_xz.y()), Eigen::Vector3f(to_xz.x(), kWide, to_xz.y()),
       Eigen::Vector3f(from_xz.x(), kWide, from_xz.y())},
      Surface::kFloor);
}

Eigen::Vector3f on_ball(float radius_m, int longitude, int latitude, int parts) {
  const float pi = std::numbers::pi_v<float>;
  const float yaw = 2.0F * pi * static_cast<float>(longitude) / static_cast<float>(2 * parts);
  const float up = pi * (static_cast<float>(latitude) / static_cast<float>(parts) - 0.5F);
  return radius_m *
         Eigen::Vector3f(std::cos(up) * std::cos(yaw), std::cos(up) * std::sin(yaw), std::sin(up));
}

Eigen::Vector3f anywhere(Random& random, double half_m) {
  const auto draw = [&] { return static_cast<float>(random.uniform(-half_m, half_m)); };
  const float x = draw();
  const float y = draw();
  return {x, y, draw()};
}

}  // namespace

TriangleMesh flat(double half_m, double z_m) {
  TriangleMesh mesh;
  const auto h = static_cast<float>(half_m);
  const auto z = static_cast<float>(z_m);
  mesh.add_quad({Eigen::Vector3f(-h, -h, z), Eigen::Vector3f(h, -h, z), Eigen::Vector3f(h, h, z),
                 Eigen::Vector3f(-h, h, z)},
                Surface::kFloor);
  return mesh;
}

TriangleMesh ramp(double angle_rad) {
  TriangleMesh mesh;
  add_strip(mesh, {-kWide, 0.0F}, {0.0F, 0.0F});
  add_strip(mesh, {0.0F, 0.0F}, {kWide, kWide * static_cast<float>(std::tan(angle_rad))});
  return mesh;
}

TriangleMesh step(double height_m) {
  TriangleMesh mesh;
  const auto z = static_cast<float>(height_m);
  add_strip(mesh, {-kWide, 0.0F}, {0.0F, 0.0F});
  add_strip(mesh, {0.0F, 0.0F}, {0.0F, z});
  add_strip(mesh, {0.0F, z}, {kWide, z});
  return mesh;
}

TriangleMesh wall(double x_m, double height_m) {
  TriangleMesh mesh;
  const auto x = static_cast<float>(x_m);
  const auto z = static_cast<float>(height_m);
  add_strip(mesh, {-kWide, 0.0F}, {kWide, 0.0F});
  add_strip(mesh, {x, 0.0F}, {x + 0.01F, z});
  add_strip(mesh, {x + 0.01F, z}, {x + 0.02F, 0.0F});
  return mesh;
}

TriangleMesh gap(double half_width_m) {
  TriangleMesh mesh;
  const auto half = static_cast<float>(half_width_m);
  add_strip(mesh, {-kWide, 0.0F}, {-half, 0.0F});
  add_strip(mesh, {half, 0.0F}, {kWide, 0.0F});
  return mesh;
}

TriangleMesh room(const Eigen::Vector3f& half) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0F, 1.0F}) {
      const Eigen::Vector3f out = side * half[axis] * Eigen::Vector3f::Unit(axis);
      const Eigen::Vector3f u = half[(axis + 1) % 3] * Eigen::Vector3f::Unit((axis + 1) % 3);
      const Eigen::Vector3f v =
          -side * half[(axis + 2) % 3] * Eigen::Vector3f::Unit((axis + 2) % 3);
      mesh.add_quad({out - u - v, out + u - v, out + u + v, out - u + v}, Surface::kWall);
    }
  return mesh;
}

TriangleMesh ball(float radius_m, int parts) {
  TriangleMesh mesh;
  for (int longitude = 0; longitude < 2 * parts; ++longitude)
    for (int latitude = 0; latitude < parts; ++latitude)
      mesh.add_quad({on_ball(radius_m, longitude, latitude, parts),
                     on_ball(radius_m, longitude + 1, latitude, parts),
                     on_ball(radius_m, longitude + 1, latitude + 1, parts),
                     on_ball(radius_m, longitude, latitude + 1, parts)},
                    Surface::kRock);
  return mesh;
}

TriangleMesh soup(int triangles, std::uint64_t seed) {
  TriangleMesh mesh;
  Random random(seed);
  for (int i = 0; i < triangles; ++i) {
    const Eigen::Vector3f centre = anywhere(random, 4.0);
    const Eigen::Vector3f a = anywhere(random, 1.0);
    const Eigen::Vector3f b = anywhere(random, 1.0);
    mesh.add_triangle(centre, centre + a, centre + b, Surface::kRock);
  }
  return mesh;
}

}  // namespace warren::world::test
