// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <doctest/doctest.h>

#include "core/layer/publisher.hpp"
#include "tests/core/layer/merge_peer.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;
using test::MergePeer;
using test::Room;

namespace {

constexpr LayerId kOrigin{7, 1, 0x1234};
constexpr Point3f kSensor{-3.0F, -2.0F, 0.1F};

// Occupied voxels around where the person stood, between floor and ceiling.
int occupied_around(MergeMap& map, const Room& room) {
  const float reach = room.column_radius_m + 0.2F;
  const auto low = map.lattice().key_of(room.column_x_m - reach, room.column_y_m - reach, -1.2);
  const auto high = map.lattice().key_of(room.column_x_m + reach, room.column_y_m + reach, 1.2);
  int occupied = 0;
  map.for_each_known_voxel({*low, *high}, [&](const VoxelKey&, const MergedVoxel& voxel) {
    if (voxel.code.state() == VoxelState::kOccupied) ++occupied;
  });
  return occupied;
}

void check_same(const SelfMap& self, MergeMap& merged) {
  std::uint64_t known = 0;
  self.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float) {
    REQUIRE(merged.voxel(key).code.state() == state);
    ++known;
  });
  merged.for_each_known_voxel({}, [&](const VoxelKey&, const MergedVoxel&) { --known; });
  CHECK(known == 0);
}

}  // namespace

TEST_CASE("a person who walked on is gone from the merge-map of a peer fed by packets alone") {
  const Room with_person;
  Room empty = with_person;
  empty.column_x_m = std::numeric_limits<float>::quiet_NaN();
  const test::Lidar lidar{48, 720, -0.4F, 0.4F, 0.0F};
  const auto person = test::scan_room(with_person, lidar, kSensor, 1);
  const auto nobody = test::scan_room(empty, lidar, kSensor, 1);

  SelfMap self(SelfMapConfig{});
  Replica layer(kOrigin, kDefaultResolution);
  MergePeer peer(kOrigin, self.lattice().resolution_m());
  std::uint32_t cursor = 0;
  const auto tick = [&](const test::SimulatedScan& scan) {
    self.integrate(scan.view());
    layer.publish(blocks_changed_since(self, cursor));
    cursor = self.cursor();
    peer.catch_up(layer);
  };
  for (int i = 0; i < 10; ++i) tick(person);
  CHECK(occupied_around(peer.map(), with_person) > 50);
  check_same(self, peer.map());
  for (int i = 0; i < 9; ++i) tick(nobody);
  CHECK(occupied_around(peer.map(), with_person) == 0);
  check_same(self, peer.map());
}
