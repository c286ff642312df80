// SPDX-License-Identifier: Apache-2.0
#include "tools/world/floor_plan.hpp"

#include <doctest/doctest.h>

#include "tests/tools/world/mesh_measures.hpp"
#include "tools/world/random.hpp"

namespace warren::world {
namespace {

Eigen::AlignedBox3d air(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return {low, high};
}

}  // namespace

TEST_CASE("a carved box is six faces that enclose its volume from inside") {
  FloorPlan plan({Eigen::Vector2d(0, 0), Eigen::Vector2d(10, 10)}, 0.25);
  plan.carve(air({1, 2, 0}, {4, 4, 3}));
  const TriangleMesh mesh = plan.mesh();
  CHECK(mesh.triangles.size() == 12);
  CHECK(test::volume_m3(mesh) == doctest::Approx(-18.0));
}

TEST_CASE("air that touches the rim of the plan is closed there") {
  FloorPlan plan({Eigen::Vector2d(0, 0), Eigen::Vector2d(2, 2)}, 0.5);
  plan.carve(air({0, 0, 0}, {2, 2, 1}));
  CHECK(test::volume_m3(plan.mesh()) == doctest::Approx(-4.0));
}

TEST_CASE("storeys, pits and doors enclose exactly the air that brute force counts") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    FloorPlan plan({Eigen::Vector2d(-3, -3), Eigen::Vector2d(3, 3)}, 0.5);
    bool is_air[12][12][8] = {};
    for (int i = 0; i < 12; ++i) {
      const auto x = static_cast<int>(random.below(9));
      const auto y = static_cast<int>(random.below(9));
      const auto z = static_cast<int>(random.below(7));
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          for (int c = 0; c < 2; ++c) is_air[x + a][y + b][z + c] = true;
      plan.carve(air({x * 0.5 - 3, y * 0.5 - 3, z * 1.0}, {x * 0.5 - 1.5, y * 0.5 - 1.5, z + 2.0}));
    }
    double volume = 0.0;
    for (const auto& plane : is_air)
      for (const auto& row : plane)
        for (const bool cell : row) volume += cell ? 0.25 : 0.0;
    CHECK(test::volume_m3(plan.mesh()) == doctest::Approx(-volume));
  }
}

}  // namespace warren::world
