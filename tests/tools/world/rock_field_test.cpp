// SPDX-License-Identifier: Apache-2.0
#include "tools/world/rock_field.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "tests/tools/world/mesh_measures.hpp"

namespace warren::world {
namespace {

RockField::Settings smooth(Section section) {
  return {.section = section, .wall_noise_m = 0.0, .floor_noise_m = 0.0, .merge_m = 0.01};
}

Passage passage(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {{from, 1.5, 2.5}, {to, 1.5, 2.5}};
}

}  // namespace

TEST_CASE("air begins at the floor line and ends at the roof and the walls") {
  for (const Section section : {Section::kOval, Section::kDrift}) {
    const RockField field(smooth(section), {passage({0, 0, 1}, {4, 0, 1})});
    CHECK(field.value({2, 0, 0.95}) > 0.0);
    CHECK(field.value({2, 0, 1.05}) < 0.0);
    CHECK(field.value({2, 0, 3.45}) < 0.0);
    CHECK(field.value({2, 0, 3.55}) > 0.0);
    CHECK(field.value({2, 1.45, 2.0}) < 0.0);
    CHECK(field.value({2, 1.55, 2.0}) > 0.0);
  }
}

TEST_CASE("the floor follows the line over bends in slope and where passages meet") {
  const std::vector<Passage> passages = {
      passage({0, 0, 0}, {2, 0, 0}), passage({2, 0, 0}, {4, 0, 1}), passage({2, 0, 0}, {2, 2, -1})};
  const RockField field(smooth(Section::kOval), passages);
  for (const Passage& way : passages) {
    for (int tenth = 0; tenth <= 10; ++tenth) {
      const double t = 0.1 * tenth;
      const Eigen::Vector3d place = way.from.floor + t * (way.to.floor - way.from.floor);
      CHECK(std::abs(field.ground_z(place + Eigen::Vector3d(0, 0, 0.6)) - place.z()) < 0.1);
    }
  }
}

TEST_CASE("a storey above does not change the floor below") {
  const RockField one(smooth(Section::kOval), {passage({0, 0, 0}, {4, 0, 0})});
  const RockField two(smooth(Section::kOval),
                      {passage({0, 0, 0}, {4, 0, 0}), passage({2, -2, 5}, {2, 2, 5})});
  for (int tenth = -10; tenth < 30; ++tenth) {
    const double z = 0.1 * tenth;
    CHECK(one.value({2, 0.3, z}) == doctest::Approx(two.value({2, 0.3, z})));
  }
}

TEST_CASE("a shaft is air through floors") {
  const RockField field(smooth(Section::kOval), {passage({0, 0, 0}, {4, 0, 0})},
                        {{{2, 0, -5}, 1.0, 1.0}});
  CHECK(field.value({2, 0, -4.5}) < 0.0);
  CHECK(field.value({2, 0, -5.5}) > 0.0);
  CHECK(field.ground_z({2, 0, 1}) == doctest::Approx(-5.0).epsilon(0.05));
}

TEST_CASE("the mesh of passages is closed and has a floor") {
  RockField::Settings settings;
  settings.seed = 77;
  const RockField field(settings, {passage({0, 0, 0}, {6, 0, 1}), passage({6, 0, 1}, {6, 7, 3})});
  const TriangleMesh mesh = mesh_of(field, 0.2);
  CHECK(test::is_closed(mesh));
  int floors = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.surfaces[i] != Surface::kFloor) continue;
    CHECK(test::normal_of(mesh, i).z() > 0.69);
    ++floors;
  }
  CHECK(floors > 100);
}

}  // namespace warren::world
