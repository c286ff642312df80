// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/merged_snapshot.hpp"

#include <map>
#include <memory>
#include <utility>

#include <doctest/doctest.h>

#include "tests/core/exchange/merged_rooms.hpp"

using namespace warren;
using test::MergedRooms;

namespace {

using Voxels = std::map<VoxelKey, std::pair<std::uint8_t, SourceNumber>>;

Voxels voxels_of(const MergedSnapshot& snapshot) {
  Voxels voxels;
  snapshot.for_each_known([&](const VoxelKey& key, VoxelCode code, SourceNumber source) {
    CHECK(voxels.emplace(key, std::pair{code.bits(), source}).second);
  });
  return voxels;
}

// The number of a layer where the two of MergedRooms are all others.
SourceNumber number_of(const MergeSourceId& id) {
  if (id.self) return 0;
  return id.layer == MergedRooms::kNorth ? 1 : 2;
}

}  // namespace

TEST_CASE("a snapshot holds the merge-map's voxels, with sources numbered by rising layer id") {
  MergedRooms rooms;
  const MergedSnapshot snapshot = snapshot_of(rooms.map(), {-1.6, 0.8, 0.0});
  CHECK(snapshot.origin() == LayerOrigin{-16, 8, 0});
  CHECK(snapshot.others() == std::vector<LayerId>{MergedRooms::kNorth, MergedRooms::kEast});
  Voxels expected;
  MapCounts counts;
  rooms.map().for_each_known_voxel({}, [&](const VoxelKey& key, const MergedVoxel& voxel) {
    const SourceNumber source = number_of(rooms.map().source(voxel.source));
    expected[key] = {voxel.code.bits(), source};
    ++(voxel.code.state() == VoxelState::kOccupied ? counts.occupied : counts.free);
  });
  CHECK(voxels_of(snapshot) == expected);
  CHECK(snapshot.counts().occupied == counts.occupied);
  CHECK(snapshot.counts().free == counts.free);
  std::map<SourceNumber, std::size_t> voxels_by_source;
  for (const auto& [key, voxel] : expected) ++voxels_by_source[voxel.second];
  for (SourceNumber source = 0; source <= 2; ++source) CHECK(voxels_by_source[source] > 1000);
}

TEST_CASE("a snapshot tells the state of any voxel, also unknown and outside the key space") {
  MergedRooms rooms;
  const MergedSnapshot snapshot = snapshot_of(rooms.map(), Eigen::Vector3d::Zero());
  REQUIRE(snapshot.bounds());
  const KeyBox& box = *snapshot.bounds();
  std::size_t different = 0;
  for (std::int32_t x = box.low.x - 9; x <= box.high.x + 9; ++x) {
    for (std::int32_t y = box.low.y - 9; y <= box.high.y + 9; ++y) {
      for (const std::int32_t z : {box.low.z - 1, 0, box.low.z + 3}) {
        const VoxelKey key{x, y, z};
        different += snapshot.state(key) == rooms.map().voxel(key).code.state() ? 0 : 1;
      }
    }
  }
  CHECK(different == 0);
  CHECK(snapshot.state({kKeyMax + 1, 0, 0}) == VoxelState::kUnknown);
}

TEST_CASE("a snapshot stays as it is when layers are removed, and when it is copied") {
  auto rooms = std::make_unique<MergedRooms>();
  MergedSnapshot snapshot = snapshot_of(rooms->map(), Eigen::Vector3d::Zero());
  const Voxels before = voxels_of(snapshot);
  REQUIRE(rooms->map().remove_layer(MergedRooms::kEast) == MergeResult::kDone);
  const MergedSnapshot after = snapshot_of(rooms->map(), Eigen::Vector3d::Zero());
  CHECK(after.others() == std::vector<LayerId>{MergedRooms::kNorth});
  CHECK(voxels_of(after).size() < before.size());
  rooms.reset();
  CHECK(voxels_of(snapshot) == before);
  const MergedSnapshot copy = snapshot;
  snapshot = after;
  CHECK(voxels_of(copy) == before);
}

TEST_CASE("the snapshot of an empty merge-map is empty") {
  MergeMap map({0.1});
  const MergedSnapshot snapshot = snapshot_of(map, Eigen::Vector3d::Zero());
  CHECK(voxels_of(snapshot).empty());
  CHECK_FALSE(snapshot.bounds());
  CHECK(snapshot.others().empty());
  CHECK(snapshot.state({}) == VoxelState::kUnknown);
}
