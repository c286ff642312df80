// SPDX-License-Identifier: Apache-2.0
#include "tools/world/placement.hpp"

#include <numbers>

#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"

using namespace warren::world;

namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

Placement place_on(const TriangleMesh& mesh, const Vehicle& vehicle, const Stand& stand) {
  return place(Caster(mesh), vehicle, stand);
}

// A ridge along x, as a gravel bank between wheel tracks.
TriangleMesh ridge(double height_m) {
  TriangleMesh mesh = test::flat(5.0);
  const auto z = static_cast<float>(height_m);
  const auto add_side = [&](float y, float turn) {
    mesh.add_quad({Eigen::Vector3f(-5.0F * turn, y, 0.0F), Eigen::Vector3f(5.0F * turn, y, 0.0F),
                   Eigen::Vector3f(5.0F * turn, 0.0F, z), Eigen::Vector3f(-5.0F * turn, 0.0F, z)},
                  Surface::kRubble);
  };
  add_side(-0.15F, 1.0F);
  add_side(0.15F, -1.0F);
  return mesh;
}

}  // namespace

TEST_CASE("flat ground carries a vehicle level, at any yaw") {
  const TriangleMesh mesh = test::flat(5.0, 1.0);
  for (const Vehicle& vehicle : {husky(), spot()})
    for (int part = 0; part < 8; ++part) {
      const Placement placed = place_on(mesh, vehicle, {0.3, -0.2, 1.05, part * 45.0 * kDeg});
      REQUIRE(placed.is_ok());
      CHECK((placed.T_world_base->translation() - Eigen::Vector3d(0.3, -0.2, 1.0)).norm() < 1e-4);
      CHECK(std::abs(placed.roll_rad) < 1e-4);
      CHECK(std::abs(placed.pitch_rad) < 1e-4);
    }
}

TEST_CASE("a ramp tilts a vehicle as it lies: nose up, nose down, to the side") {
  const TriangleMesh mesh = test::ramp(20.0 * kDeg);
  const double z = 5.0 * std::tan(20.0 * kDeg);
  for (const Vehicle& vehicle : {husky(), spot()}) {
    const Placement up = place_on(mesh, vehicle, {5.0, 0.0, z, 0.0});
    const Placement down = place_on(mesh, vehicle, {5.0, 0.0, z, 180.0 * kDeg});
    const Placement across = place_on(mesh, vehicle, {5.0, 0.0, z, 90.0 * kDeg});
    CHECK(up.is_ok());
    CHECK(down.is_ok());
    CHECK(across.is_ok());
    CHECK(up.pitch_rad == doctest::Approx(-20.0 * kDeg).epsilon(0.01));
    CHECK(down.pitch_rad == doctest::Approx(20.0 * kDeg).epsilon(0.01));
    CHECK(across.roll_rad == doctest::Approx(-20.0 * kDeg).epsilon(0.01));
    // The frame's axes say the same: x climbs.
    CHECK(up.T_world_base->linear()(2, 0) == doctest::Approx(std::sin(20.0 * kDeg)).epsilon(0.01));
    CHECK(across.T_world_base->linear()(2, 1) ==
          doctest::Approx(-std::sin(20.0 * kDeg)).epsilon(0.01));
  }
}

TEST_CASE("45 degrees are too steep") {
  const TriangleMesh mesh = test::ramp(45.0 * kDeg);
  for (const Vehicle& vehicle : {husky(), spot()})
    for (const double yaw_deg : {0.0, 90.0, 180.0})
      CHECK(place_on(mesh, vehicle, {5.0, 0.0, 5.0, yaw_deg * kDeg}).verdict == Verdict::kTooSteep);
}

TEST_CASE("a low step can be stood on with two wheels, a high one cannot") {
  CHECK(place_on(test::step(0.1), husky(), {0.0, 0.0, 0.0, 0.0}).is_ok());
  CHECK_FALSE(place_on(test::step(0.4), husky(), {0.0, 0.0, 0.0, 0.0}).is_ok());
  CHECK(place_on(test::step(0.25), spot(), {0.0, 0.0, 0.0, 0.0}).is_ok());
  CHECK_FALSE(place_on(test::step(0.8), spot(), {0.0, 0.0, 0.0, 0.0}).is_ok());
}

TEST_CASE("a ridge between the wheels carries a Husky by its belly, a Spot steps over it") {
  const Stand stand{0.0, 0.0, 0.0, 0.0};
  CHECK(place_on(ridge(0.10), husky(), stand).is_ok());
  CHECK(place_on(ridge(0.16), husky(), stand).verdict == Verdict::kHighCentred);
  CHECK(place_on(ridge(0.16), spot(), stand).is_ok());
}

TEST_CASE("a threshold across the way below the belly does so too") {
  CHECK(place_on(test::wall(0.0, 0.10), husky(), {0.0, 0.0, 0.0, 0.0}).is_ok());
  CHECK(place_on(test::wall(0.0, 0.16), husky(), {0.0, 0.0, 0.0, 0.0}).verdict ==
        Verdict::kHighCentred);
}

TEST_CASE("wheels bridge a crack but do not hang over a gap") {
  const double front_m = husky().wheelbase_m / 2.0;
  CHECK(place_on(test::gap(0.03), husky(), {-front_m, 0.0, 0.0, 0.0}).is_ok());
  CHECK(place_on(test::gap(0.5), husky(), {-front_m, 0.0, 0.0, 0.0}).verdict == Verdict::kNoGround);
  CHECK(place_on(test::gap(0.1), husky(), {0.0, 0.0, 0.0, 0.0}).is_ok());  // between the axles
}

TEST_CASE("a wall blocks where the body or a wheel should be, and not beyond") {
  for (const Vehicle& vehicle : {husky(), spot()}) {
    CHECK(place_on(test::wall(0.3, 2.0), vehicle, {0.0, 0.0, 0.0, 0.0}).verdict ==
          Verdict::kBlocked);
    CHECK(place_on(test::wall(0.4, 2.0), vehicle, {0.0, 0.0, 0.0, 0.0}).verdict ==
          Verdict::kBlocked);
    CHECK(place_on(test::wall(0.6, 2.0), vehicle, {0.0, 0.0, 0.0, 0.0}).is_ok());
  }
}

TEST_CASE("a ceiling lower than the vehicle blocks it") {
  TriangleMesh mesh = test::flat(5.0);
  mesh.add_quad({Eigen::Vector3f(-5, 5, 0.7F), Eigen::Vector3f(5, 5, 0.7F),
                 Eigen::Vector3f(5, -5, 0.7F), Eigen::Vector3f(-5, -5, 0.7F)},
                Surface::kCeiling);
  CHECK(place_on(mesh, husky(), {0.0, 0.0, 0.0, 0.0}).verdict == Verdict::kBlocked);
  Vehicle low = husky();
  low.height_m = 0.6;
  CHECK(place_on(mesh, low, {0.0, 0.0, 0.0, 0.0}).is_ok());
}

TEST_CASE("contacts far from one plane rock") {
  TriangleMesh mesh = test::flat(5.0);  // a block below one wheel alone
  mesh.append(test::flat(0.12), Eigen::Isometry3d(Eigen::Translation3d(0.256, 0.277, 0.4)));
  CHECK(place_on(mesh, husky(), {0.0, 0.0, 0.0, 0.0}).verdict == Verdict::kRocking);
}

TEST_CASE("of two floors above each other the near one is stood on") {
  TriangleMesh mesh = test::flat(5.0);
  mesh.append(test::flat(5.0, 3.0));
  const Placement low = place_on(mesh, husky(), {0.0, 0.0, 0.1, 0.0});
  const Placement high = place_on(mesh, husky(), {0.0, 0.0, 3.1, 0.0});
  REQUIRE(low.is_ok());
  REQUIRE(high.is_ok());
  CHECK(std::abs(low.T_world_base->translation().z()) < 1e-4);
  CHECK(high.T_world_base->translation().z() == doctest::Approx(3.0));
}
