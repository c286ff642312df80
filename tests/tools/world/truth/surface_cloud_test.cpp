// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/surface_cloud.hpp"

#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"
#include "tools/world/truth/visible_cloud.hpp"

using namespace warren::world;

TEST_CASE("every triangle gets samples by its area, and they lie on it") {
  TriangleMesh mesh = test::flat(5.0);                                    // 100 m2
  mesh.add_triangle({0, 0, 3}, {2, 0, 3}, {0, 2, 3}, Surface::kCeiling);  // 2 m2
  mesh.append(test::flat(0.001, 5.0));                                    // next to nothing
  const auto samples = sample_surface(mesh, 0.1, Random(1));
  CHECK(samples.size() == doctest::Approx(10200).epsilon(0.001));
  const auto counts = count_by_surface(samples);
  CHECK(counts[static_cast<std::size_t>(Surface::kCeiling)] == doctest::Approx(200).epsilon(0.01));
  int quarter = 0;
  for (const SurfaceSample& sample : samples) {
    const Eigen::Vector3f& p = sample.position;
    if (sample.surface == Surface::kCeiling)
      CHECK((p.x() >= 0.0F && p.y() >= 0.0F && p.x() + p.y() <= 2.0F && p.z() == 3.0F));
    if (sample.surface == Surface::kFloor && p.x() > 0.0F && p.y() > 0.0F) ++quarter;
  }
  CHECK(quarter == doctest::Approx(2500).epsilon(0.05));
}

TEST_CASE("of a room with a pillar's shadow only the lit part is seen, cables counted apart") {
  TriangleMesh mesh = test::flat(5.0);
  // A screen at x = 1, 1 m high, and a cable strip behind it on the floor, another in front.
  mesh.add_quad({Eigen::Vector3f(1, -5, 0), Eigen::Vector3f(1, 5, 0), Eigen::Vector3f(1, 5, 1),
                 Eigen::Vector3f(1, -5, 1)},
                Surface::kWall);
  for (const float x : {-1.0F, 1.5F})
    mesh.add_quad({Eigen::Vector3f(x, -1, 0.01F), Eigen::Vector3f(x + 0.02F, -1, 0.01F),
                   Eigen::Vector3f(x + 0.02F, 1, 0.01F), Eigen::Vector3f(x, 1, 0.01F)},
                  Surface::kCable);
  const Caster caster(mesh);
  const std::vector<Eigen::Isometry3d> eye{Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 2.0))};
  const auto samples = sample_surface(mesh, 0.05, Random(2));
  const auto seen = visible_part(samples, Sight(caster, eye, {}));
  // From 2 m up, a screen 1 m high at 1 m shades the floor from x = 1 to 2.
  for (const SurfaceSample& sample : seen)
    if (sample.surface == Surface::kFloor)
      CHECK((sample.position.x() < 1.01F || sample.position.x() > 1.99F));
  const auto cable = static_cast<std::size_t>(Surface::kCable);
  const std::size_t in_front = count_by_surface(seen)[cable];
  CHECK(in_front ==
        doctest::Approx(0.5 * static_cast<double>(count_by_surface(samples)[cable])).epsilon(0.1));
}
