// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/self_map.hpp"

#include <doctest/doctest.h>
#include <malloc.h>

#include "tests/support/simulated_scans.hpp"
#include "tests/support/under_sanitizer.hpp"

using namespace warren;

namespace {

SelfMap room_map(double resolution_m = 0.1) {
  SelfMap map({resolution_m, SensorModel{}, false});
  for (const auto& scan : test::walk_through_room(test::Room{}, test::Lidar{}, 8)) {
    map.integrate(scan.view());
  }
  return map;
}

}  // namespace

TEST_CASE("a map can be looked up by key and by point") {
  const SelfMap map = room_map();
  std::uint64_t looked = 0;
  map.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float log_odds) {
    CHECK(map.state(key) == state);
    CHECK(*map.log_odds(key) == log_odds);
    CHECK((log_odds >= 0.0F) == (state == VoxelState::kOccupied));
    const Point3f centre{static_cast<float>(map.lattice().centre_m(key.x)),
                         static_cast<float>(map.lattice().centre_m(key.y)),
                         static_cast<float>(map.lattice().centre_m(key.z))};
    CHECK(map.state(centre) == state);
    ++looked;
  });
  const MapCounts counts = map.counts();
  CHECK(looked == counts.free + counts.occupied);
  CHECK(map.state(VoxelKey{5000, 0, 0}) == VoxelState::kUnknown);
  CHECK_FALSE(map.log_odds(VoxelKey{5000, 0, 0}));
  CHECK(map.state(Point3f{1e30F, 0.0F, 0.0F}) == VoxelState::kUnknown);
}

TEST_CASE("a box visits what a filter of the whole map keeps") {
  const SelfMap map = room_map();
  const KeyBox box{{-13, -21, -9}, {17, 5, 3}};
  std::uint64_t in_box = 0;
  map.for_each_known_voxel(box, [&](const VoxelKey& key, VoxelState, float) {
    CHECK(box.contains(key));
    ++in_box;
  });
  std::uint64_t wanted = 0;
  map.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState, float) {
    if (box.contains(key)) ++wanted;
  });
  CHECK(wanted > 100);
  CHECK(in_box == wanted);
}

TEST_CASE("bounds hold every known voxel") {
  const SelfMap map = room_map();
  const auto bounds = map.bounds();
  REQUIRE(bounds);
  map.for_each_known_voxel(
      {}, [&](const VoxelKey& key, VoxelState, float) { CHECK(bounds->contains(key)); });
  CHECK_FALSE(SelfMap(SelfMapConfig{}).bounds());
}

TEST_CASE("a copy is a snapshot that later scans do not touch") {
  SelfMap map = room_map();
  const SelfMap snapshot = map;
  const MapCounts before = snapshot.counts();
  map.integrate(test::scan_room(test::Room{}, test::Lidar{}, {3.0F, 2.0F, 0.0F}, 5).view());
  CHECK(map.counts().free > before.free);
  CHECK(snapshot.counts().free == before.free);
  SelfMap continued = snapshot;
  continued.integrate(test::scan_room(test::Room{}, test::Lidar{}, {3.0F, 2.0F, 0.0F}, 5).view());
  CHECK(continued.counts().free == map.counts().free);
}

TEST_CASE("the order of points and their density in a voxel do not matter") {
  auto scan = test::scan_room(test::Room{}, test::Lidar{}, {1.0F, -1.0F, 0.0F}, 3);
  SelfMap once(SelfMapConfig{});
  once.integrate(scan.view());
  auto doubled = scan;
  doubled.points_layer.insert(doubled.points_layer.end(), scan.points_layer.rbegin(),
                              scan.points_layer.rend());
  SelfMap twice(SelfMapConfig{});
  twice.integrate(doubled.view());
  once.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState, float log_odds) {
    CHECK(twice.log_odds(key) == log_odds);
  });
  CHECK(once.counts().free == twice.counts().free);
}

TEST_CASE("blocks that are free throughout are given back") {
  const test::Lidar dense{200, 1000, -1.0F, 1.0F, 0.0F};
  const auto scan = test::scan_room(test::Room{}, dense, {0.0F, 0.0F, 0.1F}, 1);
  SelfMap map(SelfMapConfig{});
  map.integrate(scan.view());
  CHECK(map.blocks().block_count() == map.counts().blocks);
  for (int i = 0; i < 10; ++i) map.integrate(scan.view());
  CHECK(map.blocks().block_count() < map.counts().blocks * 3 / 4);
}

TEST_CASE("memory accounting agrees with the heap") {
  if (test::kUnderSanitizer) {
    MESSAGE("SKIPPED: a sanitizer's heap has no mallinfo2()");
    return;
  }
  const auto live = [] {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  const std::size_t before = live();
  const SelfMap map = room_map(0.05);
  const auto held = static_cast<double>(live() - before);
  CHECK(static_cast<double>(map.memory_bytes()) == doctest::Approx(held).epsilon(0.15));
}
