// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/drivability.hpp"

#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"

using namespace warren::world;

namespace {

Drivability at(const TriangleMesh& mesh, const Vehicle& vehicle, const Eigen::Vector3d& ground) {
  return drivability_at(Caster(mesh), vehicle, ground);
}

}  // namespace

TEST_CASE("ground points are all floors above each other, on the grid, and no ceilings") {
  TriangleMesh mesh = test::room({2.0F, 2.0F, 1.0F});  // floor at -1
  mesh.append(test::flat(0.6, 0.5));                   // a table
  const auto points = ground_points(Caster(mesh), mesh.bounds().cast<double>(), 0.5);
  std::size_t on_table = 0;
  for (const Eigen::Vector3d& p : points) {
    CHECK(std::abs(p.x() / 0.5 - std::round(p.x() / 0.5)) < 1e-9);
    const bool is_table = std::abs(p.z() - 0.5) < 1e-5;
    CHECK((is_table || std::abs(p.z() + 1.0) < 1e-5));
    if (is_table) ++on_table;
  }
  CHECK(on_table == 9);
  CHECK(points.size() >= 9 + 49);  // those on the walls' edges may count or not
}

TEST_CASE("open flat ground can be stood and moved on at every heading") {
  const TriangleMesh mesh = test::flat(5.0);
  for (const Vehicle& vehicle : {husky(), spot()}) {
    const Drivability shares = at(mesh, vehicle, {0.0, 0.0, 0.0});
    CHECK(shares.stand == doctest::Approx(1.0));
    CHECK(shares.move == doctest::Approx(1.0));
  }
}

TEST_CASE("a ramp of 20 degrees carries, one of 45 does not") {
  const Drivability gentle = at(test::ramp(0.349), husky(), {4.0, 0.0, 4.0 * std::tan(0.349)});
  CHECK(gentle.stand == doctest::Approx(1.0));
  CHECK(gentle.move == doctest::Approx(1.0));
  const Drivability steep = at(test::ramp(0.785), husky(), {4.0, 0.0, 4.0 * std::tan(0.785)});
  CHECK(steep.stand == 0.0);
  CHECK(steep.move == 0.0);
}

TEST_CASE("before a step of 0.2 m a Husky can stand but not go ahead, a Spot goes up") {
  const TriangleMesh mesh = test::step(0.2);
  const Eigen::Vector3d before(-0.6, 0.0, 0.0);
  const Drivability wheels = at(mesh, husky(), before);
  const Drivability legs = at(mesh, spot(), before);
  CHECK(wheels.stand == doctest::Approx(1.0));
  CHECK(wheels.move < 0.8);
  CHECK(wheels.move > 0.2);  // sideways and back
  CHECK(legs.move == doctest::Approx(1.0));
}

TEST_CASE("beside a wall only what leads along or away is free") {
  const TriangleMesh mesh = test::wall(0.5, 2.0);
  const Drivability shares = at(mesh, husky(), {0.05, 0.0, 0.0});
  CHECK(shares.stand > 0.0);
  CHECK(shares.move < shares.stand);
}

TEST_CASE("labels carry a place and every vehicle's shares") {
  const TriangleMesh mesh = test::flat(2.0);
  const Caster caster(mesh);
  const std::vector<Vehicle> vehicles{husky(), spot()};
  const Eigen::AlignedBox3d region(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1));
  const auto labels = label_ground(caster, vehicles, region, 0.5);
  REQUIRE(labels.size() == 25);
  for (const GroundTruth& label : labels) {
    REQUIRE(label.by_vehicle.size() == 2);
    CHECK(label.by_vehicle[0].stand == doctest::Approx(1.0));
  }
}
