// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "tests/core/layer/merge_peer.hpp"
#include "tests/core/layer/merge_world.hpp"

using namespace warren;
using test::MergePeer;
using test::voxels_of;

namespace {

constexpr LayerId kFirst{1, 1, 11};
constexpr double kResolution_m = 0.1;
const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();
constexpr VoxelKey kVoxel{3, 2, 1};

CodedBlock block_with(VoxelCode code, const VoxelKey& key = kVoxel) {
  BlockCodes codes;
  codes.set(morton9(key.x, key.y, key.z), code);
  return {ordinal_of(block_of(key)), CodeBlock(codes)};
}

}  // namespace

TEST_CASE("packets in another order or twice give the same merge-map") {
  test::Random random(5);
  Replica origin(kFirst, kDefaultResolution);
  std::vector<DiffPacket> packets;
  for (int tick = 0; tick < 6; ++tick) {
    const Revision before = origin.holdings().at(0);
    std::vector<CodedBlock> blocks;
    for (std::int32_t x = 0; x < 6; ++x) {
      if (test::chance(random, 70)) {
        blocks.push_back({ordinal_of({x, 0, 0}), CodeBlock(test::random_codes(random))});
      }
    }
    origin.publish(blocks);
    KeyInterval keys;
    while (auto packet = origin.encode({keys, before, 700})) {
      keys.first = packet->claim.keys.end;
      packets.push_back(std::move(*packet));
    }
  }
  MergePeer straight(kFirst, kResolution_m);
  straight.catch_up(origin);
  for (int again = 0; again < 10; ++again) {
    Replica replica(kFirst, kDefaultResolution);
    MergeMap map({kResolution_m});
    REQUIRE(map.add_layer(kFirst, replica, kResolution_m, kHere) == MergeResult::kDone);
    while (replica.holdings() != origin.holdings()) {
      std::shuffle(packets.begin(), packets.end(), random);
      for (const DiffPacket& packet : packets) {
        replica.apply(kFirst, packet.bytes);
        for (std::int32_t x = 0; x < 6; ++x) map.block_changed(kFirst, ordinal_of({x, 0, 0}));
      }
    }
    REQUIRE(voxels_of(map) == voxels_of(straight.map()));
  }
}

TEST_CASE("a robot that stops has its last part with its peers, however small") {
  Replica origin(kFirst, kDefaultResolution);
  MergePeer peer(kFirst, kResolution_m);
  origin.publish({{block_with(VoxelCode::occupied(3, false))}});
  peer.catch_up(origin);
  origin.publish({{block_with(VoxelCode::occupied(4, false))}});
  peer.catch_up(origin);
  CHECK(peer.map().voxel(kVoxel).code == VoxelCode::occupied(4, false));
  CHECK_FALSE(origin.encode({{}, peer.replica().holdings().at(0)}));
}

TEST_CASE("a robot that restarts goes on with its layer, and its peers follow") {
  MergePeer peer(kFirst, kResolution_m);
  std::vector<StoredBlock> stored;
  Holdings holdings;
  {
    Replica origin(kFirst, kDefaultResolution);
    origin.publish({{block_with(VoxelCode::occupied(3, false))}});
    origin.publish({{block_with(VoxelCode::occupied(4, false))}});
    peer.catch_up(origin);
    holdings = origin.holdings();
    origin.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
      stored.push_back({block, found.history.latest(), found.codes});
      return true;
    });
  }
  Replica restarted(kFirst, kDefaultResolution, holdings, stored);
  CHECK(restarted.publish({{block_with(VoxelCode::occupied(9, true))}}) == Revision{3});
  peer.catch_up(restarted);
  CHECK(peer.map().voxel(kVoxel).code == VoxelCode::occupied(9, true));
}
