// SPDX-License-Identifier: Apache-2.0
#include "tools/world/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "tests/tools/world/mesh_measures.hpp"
#include "tools/world/boulders.hpp"
#include "tools/world/cables.hpp"
#include "tools/world/rails.hpp"

namespace warren::world {
namespace {

bool has_vertex(const TriangleMesh& mesh, const Eigen::Vector3d& place) {
  return std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Eigen::Vector3f& v) {
    return (v.cast<double>() - place).norm() < 1e-5;
  });
}

}  // namespace

TEST_CASE("a box has its volume, is closed and faces outward") {
  const TriangleMesh mesh =
      box({Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(2, 4, 6)}, Surface::kWall);
  CHECK(mesh.triangles.size() == 12);
  CHECK(test::volume_m3(mesh) == doctest::Approx(6.0));
  CHECK(test::is_closed_in_space(mesh));
}

TEST_CASE("a ramp rises at the angle that was asked for") {
  for (const double angle_deg : {5.0, 15.0, 30.0, 45.0}) {
    const Ramp ramp{
        .angle_rad = angle_deg * std::numbers::pi / 180.0, .height_m = 0.8, .width_m = 1.2};
    const TriangleMesh mesh = wedge(ramp);
    CHECK(test::volume_m3(mesh) == doctest::Approx(0.5 * ramp.length_m() * 0.8 * 1.2));
    CHECK(test::is_closed_in_space(mesh));
    int slopes = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const double up = test::normal_of(mesh, i).z();
      if (up < 0.1 || up > 0.9999) continue;
      CHECK(std::acos(up) == doctest::Approx(ramp.angle_rad).epsilon(1e-4));
      ++slopes;
    }
    CHECK(slopes == 2);
  }
}

TEST_CASE("the nosings of a flight are where its numbers say") {
  const Stairway stairs{.foot = {1.0, 2.0, 3.0},
                        .yaw_rad = std::numbers::pi / 2.0,
                        .steps = 3,
                        .rise_m = 0.2,
                        .run_m = 0.3,
                        .width_m = 1.0};
  const auto edges = stairs.edges();
  REQUIRE(edges.size() == 3);
  CHECK((edges[0].left - Eigen::Vector3d(0.5, 2.0, 3.2)).norm() < 1e-12);
  CHECK((edges[0].right - Eigen::Vector3d(1.5, 2.0, 3.2)).norm() < 1e-12);
  CHECK((edges[2].left - Eigen::Vector3d(0.5, 2.6, 3.6)).norm() < 1e-12);
  CHECK((stairs.top() - Eigen::Vector3d(1.0, 2.6, 3.6)).norm() < 1e-12);
}

TEST_CASE("a solid flight has the volume of its blocks and vertices on every nosing") {
  const Stairway stairs{.foot = {4.0, -7.0, 1.0},
                        .yaw_rad = 0.7,
                        .steps = 12,
                        .rise_m = 0.18,
                        .run_m = 0.28,
                        .width_m = 1.1};
  const TriangleMesh mesh = solid_of(stairs);
  CHECK(test::volume_m3(mesh) == doctest::Approx(0.18 * 0.28 * 1.1 * 78).epsilon(1e-4));
  for (const auto& edge : stairs.edges()) {
    CHECK(has_vertex(mesh, edge.left));
    CHECK(has_vertex(mesh, edge.right));
  }
}

TEST_CASE("a boulder is closed, faces outward and keeps about its radius") {
  Random random(9);
  for (int i = 0; i < 20; ++i) {
    const TriangleMesh mesh = boulder({.radius_m = 0.5, .roughness = 0.2}, random);
    CHECK(mesh.triangles.size() == 20 * 16);
    CHECK(test::is_closed(mesh));
    CHECK(test::volume_m3(mesh) > 0.1);
    CHECK(test::volume_m3(mesh) < 0.9);
    for (const Eigen::Vector3f& vertex : mesh.vertices) CHECK(vertex.norm() < 0.5F * 1.2F * 1.1F);
  }
}

TEST_CASE("a cable hangs from its ends and sags in the middle by what was asked for") {
  const Cable settings{.from = {0, 0, 3}, .to = {8, 0, 3}, .sag_m = 0.5, .radius_m = 0.02};
  const TriangleMesh mesh = cable(settings);
  CHECK(test::is_closed(mesh));
  CHECK(test::volume_m3(mesh) > 0.0);
  CHECK(mesh.bounds().min().z() == doctest::Approx(2.5 - 0.02).epsilon(0.002));
  CHECK(mesh.bounds().max().z() == doctest::Approx(3.02).epsilon(0.002));
  CHECK(mesh.bounds().min().x() == doctest::Approx(0.0).epsilon(0.01));
}

TEST_CASE("a fence is as high and long as it was ordered and mostly air") {
  const TriangleMesh mesh = fence({.from = {0, 0, 0}, .to = {3, 0, 0}, .height_m = 2.0});
  CHECK(mesh.bounds().max().z() == doctest::Approx(2.0));
  CHECK(mesh.bounds().sizes().x() == doctest::Approx(3.06).epsilon(0.02));
  CHECK(test::is_closed(mesh));
  CHECK(test::volume_m3(mesh) < 0.02);
}

TEST_CASE("a stepfield stays within its plan and below its highest pillar") {
  Random random(3);
  const TriangleMesh mesh = stepfield({.rows = 4, .columns = 6, .pitch_m = 0.25}, random);
  CHECK(mesh.triangles.size() == 4 * 6 * 12);
  CHECK(mesh.bounds().sizes().x() == doctest::Approx(1.0));
  CHECK(mesh.bounds().sizes().y() == doctest::Approx(1.5));
  CHECK(mesh.bounds().max().z() <= 0.4F);
}

TEST_CASE("rails run at their gauge along the line") {
  const Rails settings;
  const TriangleMesh mesh = rails({{0, 0, 0}, {10, 0, 0}}, settings);
  CHECK(mesh.bounds().max().z() ==
        doctest::Approx(settings.sleeper_height_m + settings.rail_height_m));
  CHECK(mesh.bounds().sizes().y() == doctest::Approx(settings.sleeper_length_m));
  CHECK(test::volume_m3(mesh) > 0.0);
}

TEST_CASE("the same seed makes the same rubble") {
  Random a(5);
  Random b(5);
  Random c(6);
  const TriangleMesh mesh = rubble_pile({}, a);
  CHECK(test::is_same(mesh, rubble_pile({}, b)));
  CHECK_FALSE(test::is_same(mesh, rubble_pile({}, c)));
}

}  // namespace warren::world
