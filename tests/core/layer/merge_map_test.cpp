// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_map.hpp"

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "tests/core/layer/merge_world.hpp"

using namespace warren;
using test::MergedVoxels;
using test::voxels_of;

namespace {

constexpr LayerId kFirst{1, 1, 11};
constexpr LayerId kSecond{2, 1, 22};
constexpr double kResolution_m = 0.1;
const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();
constexpr VoxelKey kVoxel{3, 2, 1};
constexpr BlockOrdinal kBlock = ordinal_of(block_of(kVoxel));

CodedBlock block_with(VoxelCode code, const VoxelKey& key = kVoxel) {
  BlockCodes codes;
  codes.set(morton9(key.x, key.y, key.z), code);
  return {ordinal_of(block_of(key)), CodeBlock(codes)};
}

Replica layer_with(const LayerId& id, VoxelCode code) {
  Replica layer(id, kDefaultResolution);
  layer.publish({{block_with(code)}});
  return layer;
}

MergeMap merged(const Replica& first, const Replica& second) {
  MergeMap map({kResolution_m});
  REQUIRE(map.add_layer(kFirst, first, kResolution_m, kHere) == MergeResult::kDone);
  REQUIRE(map.add_layer(kSecond, second, kResolution_m, kHere) == MergeResult::kDone);
  return map;
}

Eigen::Isometry3d moved_by(double x_m, double y_m, double z_m) {
  Eigen::Isometry3d pose = kHere;
  pose.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  return pose;
}

}  // namespace

TEST_CASE("a voxel that this node knows itself is never replaced") {
  const Replica occupied = layer_with(kFirst, VoxelCode::occupied(15, true));
  const Replica free = layer_with(kSecond, VoxelCode::free());
  for (const VoxelCode own : {VoxelCode::free(), VoxelCode::occupied(1, false)}) {
    MergeMap map = merged(occupied, free);
    REQUIRE(map.open_self_layer(1, kHere) == MergeResult::kDone);
    REQUIRE(map.update_self(1, {{block_with(own)}}) == MergeResult::kDone);
    CHECK(map.voxel(kVoxel).code == own);
    CHECK(map.source(map.voxel(kVoxel).source).self);
    map.block_changed(kFirst, kBlock);
    CHECK(map.voxel(kVoxel).code == own);
    // What it forgets, others may tell again.
    REQUIRE(map.update_self(1, {{CodedBlock{kBlock, {}}}}) == MergeResult::kDone);
    CHECK(map.voxel(kVoxel).code == VoxelCode::occupied(15, true));
  }
}

TEST_CASE("of two layers of this node the later one wins, free or not") {
  MergeMap map({kResolution_m});
  REQUIRE(map.open_self_layer(2, kHere) == MergeResult::kDone);
  REQUIRE(map.open_self_layer(1, kHere) == MergeResult::kDone);
  REQUIRE(map.update_self(2, {{block_with(VoxelCode::free())}}) == MergeResult::kDone);
  REQUIRE(map.update_self(1, {{block_with(VoxelCode::occupied(9, true))}}) == MergeResult::kDone);
  CHECK(map.voxel(kVoxel).code == VoxelCode::free());
  CHECK(map.source(map.voxel(kVoxel).source).layer.number == 2);
  REQUIRE(map.move_self_layer(2, moved_by(0.1, 0.0, 0.0)) == MergeResult::kDone);
  CHECK(map.voxel(kVoxel).code == VoxelCode::occupied(9, true));
  CHECK(map.voxel(VoxelKey{4, 2, 1}).code == VoxelCode::free());
}

TEST_CASE("a layer of this node is retracted and restored too, with what it learnt in between") {
  MergeMap map({kResolution_m});
  REQUIRE(map.open_self_layer(1, kHere) == MergeResult::kDone);
  REQUIRE(map.update_self(1, {{block_with(VoxelCode::free())}}) == MergeResult::kDone);
  CHECK(map.retract_self_layer(2) == MergeResult::kUnknownLayer);
  CHECK(map.restore_self_layer(2) == MergeResult::kUnknownLayer);
  REQUIRE(map.retract_self_layer(1) == MergeResult::kDone);
  REQUIRE(map.update_self(1, {{block_with(VoxelCode::occupied(3, false))}}) == MergeResult::kDone);
  CHECK(voxels_of(map).empty());
  REQUIRE(map.restore_self_layer(1) == MergeResult::kDone);
  CHECK(map.voxel(kVoxel).code == VoxelCode::occupied(3, false));
}

TEST_CASE(
    "of others, occupied beats free, a higher cost a lower and no data, and any stair counts") {
  const auto merge_of = [](VoxelCode a, VoxelCode b) {
    const Replica first = layer_with(kFirst, a);
    const Replica second = layer_with(kSecond, b);
    MergeMap map = merged(first, second);
    const MergedVoxel voxel = map.voxel(kVoxel);
    return std::pair{voxel.code, map.source(voxel.source).layer.origin};
  };
  const auto occupied = [](CostCode cost, bool stair) { return VoxelCode::occupied(cost, stair); };
  using Told = std::pair<VoxelCode, std::uint32_t>;
  CHECK(merge_of(VoxelCode::free(), occupied(1, false)) == Told{occupied(1, false), 2});
  CHECK(merge_of(occupied(0, false), VoxelCode::free()) == Told{occupied(0, false), 1});
  CHECK(merge_of(occupied(3, false), occupied(7, false)) == Told{occupied(7, false), 2});
  CHECK(merge_of(occupied(kNoCostData, true), occupied(1, false)) == Told{occupied(1, true), 2});
  CHECK(merge_of(occupied(4, true), occupied(4, false)) == Told{occupied(4, true), 1});
  CHECK(merge_of(VoxelCode::free(), VoxelCode::free()) == Told{VoxelCode::free(), 1});
}

TEST_CASE("an overlap keeps both origins: retract one and the other's word shows") {
  const Replica first = layer_with(kFirst, VoxelCode::occupied(9, false));
  const Replica second = layer_with(kSecond, VoxelCode::occupied(2, true));
  MergeMap map = merged(first, second);
  const MergedVoxels both = voxels_of(map);
  REQUIRE(map.retract_layer(kFirst) == MergeResult::kDone);
  CHECK(map.voxel(kVoxel).code == VoxelCode::occupied(2, true));
  CHECK(map.source(map.voxel(kVoxel).source).layer == kSecond);
  REQUIRE(map.retract_layer(kSecond) == MergeResult::kDone);
  CHECK(voxels_of(map).empty());
  REQUIRE(map.restore_layer(kFirst) == MergeResult::kDone);
  CHECK(map.voxel(kVoxel).code == VoxelCode::occupied(9, false));
  REQUIRE(map.restore_layer(kSecond) == MergeResult::kDone);
  CHECK(voxels_of(map) == both);
}

TEST_CASE("a layer retracted leaves what it would be had it never been merged") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    test::Random random(seed);
    const auto layer = [&](const LayerId& id) {
      Replica replica(id, kDefaultResolution);
      std::vector<CodedBlock> blocks;
      for (std::int32_t x = -1; x <= 1; ++x) {
        blocks.push_back({ordinal_of({x, 0, 0}), CodeBlock(test::random_codes(random, 40))});
      }
      replica.publish(blocks);
      return replica;
    };
    const Replica first = layer(kFirst);
    const Replica second = layer(kSecond);
    Eigen::Isometry3d askew = moved_by(0.04, -0.13, 0.02);
    askew.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    MergeMap never({kResolution_m});
    REQUIRE(never.add_layer(kSecond, second, kResolution_m, kHere) == MergeResult::kDone);
    MergeMap map = merged(first, second);
    voxels_of(map);
    REQUIRE(map.move_layer(kFirst, askew) == MergeResult::kDone);
    CHECK(voxels_of(map) != voxels_of(never));
    REQUIRE(map.retract_layer(kFirst) == MergeResult::kDone);
    CHECK(voxels_of(map) == voxels_of(never));
  }
}

TEST_CASE("the newest word counts if so configured, and the lower id of equally new ones") {
  Replica first = layer_with(kFirst, VoxelCode::occupied(9, false));
  const Replica second = layer_with(kSecond, VoxelCode::free());
  MergeMap map({kResolution_m, MergeRule::kNewest});
  REQUIRE(map.add_layer(kSecond, second, kResolution_m, kHere) == MergeResult::kDone);
  REQUIRE(map.add_layer(kFirst, first, kResolution_m, kHere) == MergeResult::kDone);
  const auto told = [&] { return map.source(map.voxel(kVoxel).source).layer; };
  CHECK(told() == kFirst);
  map.note_time(kSecond, {1}, 200);
  CHECK(told() == kSecond);
  map.note_time(kFirst, {1}, 300);
  CHECK(told() == kFirst);
  map.note_time(kSecond, {1}, 300);
  CHECK(told() == kFirst);
  first.publish({{block_with(VoxelCode::occupied(2, false))}});
  map.block_changed(kFirst, kBlock);
  map.note_time(kFirst, {2}, 299);
  CHECK(told() == kSecond);
}

TEST_CASE("a layer that reaches out of the key space is cut there, and counted") {
  Replica layer(kFirst, kDefaultResolution);
  const VoxelKey last{kKeyMax, 0, 0};
  const VoxelCode code = VoxelCode::occupied(5, false);
  layer.publish({{block_with(code, last), block_with(code, {0, 0, 0})}});
  MergeMap map({kResolution_m});
  REQUIRE(map.add_layer(kFirst, layer, kResolution_m, kHere) == MergeResult::kDone);
  CHECK(map.blocks_outside_key_space() == 0);
  CHECK(map.voxel(last).code == code);
  REQUIRE(map.move_layer(kFirst, moved_by(0.1, 0.0, 0.0)) == MergeResult::kDone);
  CHECK(map.blocks_outside_key_space() == 1);
  CHECK(voxels_of(map).size() == 1);
  CHECK(map.voxel(VoxelKey{1, 0, 0}).code == code);
  for (const double far_m : {1e5, -1e5, 0.99e9}) {
    REQUIRE(map.move_layer(kFirst, moved_by(far_m, -far_m, 0.03)) == MergeResult::kDone);
    CHECK(map.blocks_outside_key_space() == 2);
    CHECK(voxels_of(map).empty());
  }
  REQUIRE(map.move_layer(kFirst, kHere) == MergeResult::kDone);
  CHECK(map.blocks_outside_key_space() == 0);
  CHECK(voxels_of(map).size() == 2);
  CHECK(map.voxel(VoxelKey{kKeyMax + 1, 0, 0}).code == VoxelCode{});
  CHECK(map.voxel(VoxelKey{kKeyMin - 1, 0, 0}).code == VoxelCode{});
}

TEST_CASE("poses, resolutions and layers that make no sense are refused and change nothing") {
  const Replica layer = layer_with(kFirst, VoxelCode::free());
  MergeMap map({kResolution_m});
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  Eigen::Isometry3d stretched = kHere;
  stretched.linear() *= 1.01;
  Eigen::Isometry3d mirrored = kHere;
  mirrored.linear()(0, 0) = -1.0;
  for (const auto& pose : {moved_by(not_a_number, 0.0, 0.0), moved_by(0.0, 1e30, 0.0), stretched,
                           mirrored, moved_by(0.0, 0.0, 1e9)}) {
    CHECK(map.add_layer(kFirst, layer, kResolution_m, pose) == MergeResult::kBadPose);
    CHECK(map.open_self_layer(1, pose) == MergeResult::kBadPose);
  }
  for (const double resolution_m : {0.0, -0.1, not_a_number, 0.01, 0.81}) {
    CHECK(map.add_layer(kFirst, layer, resolution_m, kHere) == MergeResult::kBadResolution);
  }
  CHECK(map.block_changed(kFirst, kBlock) == MergeResult::kUnknownLayer);
  CHECK(map.retract_layer(kFirst) == MergeResult::kUnknownLayer);
  CHECK(map.update_self(1, {}) == MergeResult::kUnknownLayer);
  REQUIRE(map.add_layer(kFirst, layer, kResolution_m, kHere) == MergeResult::kDone);
  CHECK(map.add_layer(kFirst, layer, kResolution_m, kHere) == MergeResult::kKnownLayer);
  CHECK(map.move_layer(kFirst, stretched) == MergeResult::kBadPose);
  CHECK(map.block_changed(kFirst, kOrdinalEnd - 1) == MergeResult::kDone);
  CHECK(voxels_of(map).size() == 1);
}

TEST_CASE("a voxel that was asked for before any layer reached it is known once one does") {
  const Replica layer = layer_with(kFirst, VoxelCode::free());
  MergeMap map({kResolution_m});
  CHECK(map.voxel(kVoxel) == MergedVoxel{});
  REQUIRE(map.add_layer(kFirst, layer, kResolution_m, moved_by(0.8, 0.0, 0.0)) ==
          MergeResult::kDone);
  CHECK(map.voxel(kVoxel) == MergedVoxel{});  // in the layer's region now
  for (int i = 0; i < 2; ++i) {
    REQUIRE(map.move_layer(kFirst, kHere) == MergeResult::kDone);
    CHECK(map.voxel(kVoxel).code == VoxelCode::free());
    REQUIRE(map.retract_layer(kFirst) == MergeResult::kDone);
    CHECK(map.voxel(kVoxel) == MergedVoxel{});
    REQUIRE(map.restore_layer(kFirst) == MergeResult::kDone);
    CHECK(map.voxel(kVoxel).code == VoxelCode::free());
  }
}

TEST_CASE("where more than two layers make a block each voxel still tells of its own") {
  MergeMap map({kResolution_m});
  std::vector<std::unique_ptr<Replica>> layers;
  for (std::uint32_t x = 0; x < kBlockEdge; ++x) {
    const VoxelKey key{static_cast<std::int32_t>(x), 0, 0};
    layers.push_back(std::make_unique<Replica>(LayerId{x + 1, 1, 1}, kDefaultResolution));
    layers.back()->publish(
        {{block_with(VoxelCode::occupied(static_cast<CostCode>(x), false), key)}});
    REQUIRE(map.add_layer(layers.back()->id(), *layers.back(), kResolution_m, kHere) ==
            MergeResult::kDone);
    for (std::uint32_t other = 0; other <= x; ++other) {
      const MergedVoxel voxel = map.voxel(VoxelKey{static_cast<std::int32_t>(other), 0, 0});
      CHECK(voxel.code == VoxelCode::occupied(static_cast<CostCode>(other), false));
      CHECK(map.source(voxel.source).layer == layers[other]->id());
    }
    CHECK(map.voxel(VoxelKey{0, 1, 0}) == MergedVoxel{});
  }
  for (std::uint32_t x = 1; x < kBlockEdge; ++x) map.retract_layer(layers[x]->id());
  const MergedVoxel voxel = map.voxel(VoxelKey{0, 0, 0});
  CHECK(map.source(voxel.source).layer == layers[0]->id());
}

TEST_CASE("a layer that wanders for long leaves a bounded trace, and old cursors are told so") {
  const Replica layer = layer_with(kFirst, VoxelCode::free());
  MergeMap map({kResolution_m});
  REQUIRE(map.add_layer(kFirst, layer, kResolution_m, kHere) == MergeResult::kDone);
  const std::uint64_t start = map.cursor();
  const std::size_t regions_max = MergeMap::kUntouchedRegionsMax + 2;
  std::size_t moves = 0;
  for (int x = -20; x < 20; ++x) {
    for (int y = -20; y < 20; ++y) {
      REQUIRE(map.move_layer(kFirst, moved_by(x * 6.4, y * 6.4, 6.4)) == MergeResult::kDone);
      CHECK(map.memory_bytes() < regions_max * sizeof(MergeIndex::Region) + 1000000);
      if (++moves == 100) CHECK(map.blocks_changed_since(start));
    }
  }
  CHECK_FALSE(map.blocks_changed_since(start));
  CHECK(map.blocks_changed_since(map.cursor()));
  CHECK(map.blocks_changed_since(0));
  CHECK(voxels_of(map).size() == 1);
}
