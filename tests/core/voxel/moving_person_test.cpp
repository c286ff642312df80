// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <doctest/doctest.h>

#include "core/voxel/self_map.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;
using test::Lidar;
using test::Room;

namespace {

constexpr Point3f kSensor{-3.0F, -2.0F, 0.1F};

// Occupied voxels around where the person stood, between floor and ceiling.
int occupied_around(const SelfMap& map, const Room& room) {
  const float reach = room.column_radius_m + 0.2F;
  const auto low = map.lattice().key_of(room.column_x_m - reach, room.column_y_m - reach, -1.2);
  const auto high = map.lattice().key_of(room.column_x_m + reach, room.column_y_m + reach, 1.2);
  int occupied = 0;
  map.for_each_known_voxel({*low, *high}, [&](const VoxelKey&, VoxelState state, float) {
    if (state == VoxelState::kOccupied) ++occupied;
  });
  return occupied;
}

// Scans of the empty room until the person that stood there for `seen` scans is gone.
int scans_until_gone(const SensorModel& model, int seen) {
  SelfMap map({0.1, model, false});
  const Room with_person;
  Room empty = with_person;
  empty.column_x_m = std::numeric_limits<float>::quiet_NaN();
  const Lidar lidar{48, 720, -0.4F, 0.4F, 0.0F};
  const auto person = test::scan_room(with_person, lidar, kSensor, 1);
  const auto nobody = test::scan_room(empty, lidar, kSensor, 1);
  for (int i = 0; i < seen; ++i) map.integrate(person.view());
  REQUIRE(occupied_around(map, with_person) > 50);
  int scans = 0;
  while (occupied_around(map, with_person) > 0 && scans < 1000) {
    map.integrate(nobody.view());
    ++scans;
  }
  return scans;
}

}  // namespace

// From the upper clamp (log-odds 3.51, 3.48 and 3.48) by misses of 0.405, 0.080 and 0.120 each.
TEST_CASE("a person who stood for long is gone after 9 scans with the default model") {
  CHECK(scans_until_gone(SensorModel::octomap_default(), 100) == 9);
}

TEST_CASE("a person who stood for long is gone after 44 scans with the field model") {
  CHECK(scans_until_gone(SensorModel::field(), 100) == 44);
}

TEST_CASE("a person who stood for long is gone after 29 scans with our model") {
  CHECK(scans_until_gone(SensorModel::ours(), 100) == 29);
}

TEST_CASE("a person who only passed through is gone sooner with the default model") {
  CHECK(scans_until_gone(SensorModel::octomap_default(), 1) == 3);
}
