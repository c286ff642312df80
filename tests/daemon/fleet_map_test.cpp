// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet_map.hpp"

#include <doctest/doctest.h>

namespace warren {
namespace {

const LayerOrigin kFarOrigin{8'000'000, -16'000'000, 8};

FleetMap fleet_map(SenderRules rules = {}) {
  std::uint64_t drawn = 0;
  return FleetMap({7, Resolution{}, {rules, 1200, 3}}, [drawn]() mutable { return ++drawn; });
}

// A floor, one voxel thick, over one block: all of it occupied, with this cost.
CodedBlock floor_block(const BlockKey& key, CostCode cost) {
  BlockCodes codes;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelKey in_block = place_of_morton9(place);
    codes.set(place, in_block.z == 0 ? VoxelCode::occupied(cost, false) : VoxelCode::free());
  }
  return {ordinal_of(key), CodeBlock(codes)};
}

CodedBlock one_free_voxel(const BlockKey& key) {
  BlockCodes codes;
  codes.set(0, VoxelCode::free());
  return {ordinal_of(key), CodeBlock(codes)};
}

LayerChanges changes_of(std::vector<CodedBlock> blocks, std::uint32_t number = 0) {
  return {number, kFarOrigin, {}, {0.0, 0.0, -1.0}, std::move(blocks)};
}

void tick(FleetMap& fleet, std::vector<CodedBlock> blocks) {
  const std::vector<LayerChanges> changes{changes_of(std::move(blocks))};
  fleet.tick(changes);
}

void follow(const FleetMap& fleet, Replica& copy) {
  const auto diff = fleet.diff({}, copy.holdings().lowest({}));
  REQUIRE(diff.has_value());
  REQUIRE(diff->next_key == kOrdinalEnd);
  for (const auto& packet : diff->packets) {
    REQUIRE(copy.apply(diff->id, packet) == ApplyResult::kApplied);
  }
}

// In the middle of block (x, 0, 0) of the layer, on its floor.
GroundQuestion question_at(std::int32_t block_x) {
  GroundQuestion question;
  question.source = MapSource::kMerge;
  question.T_map_base.translation =
      kFarOrigin.position_map(0.1) + Eigen::Vector3d(0.8 * block_x + 0.4, 0.4, 0.1);
  question.footprint = {0.3, 0.3};
  return question;
}

Replica earlier_layer(const std::vector<CodedBlock>& blocks) {
  Replica layer(LayerId{99, 1, 5});
  layer.publish(blocks);
  const Eigen::Vector3d origin = kFarOrigin.position_map(0.1);
  layer.pose().update_origin({1, 99, {origin, Eigen::Quaterniond::Identity()}});
  return layer;
}

}  // namespace

TEST_CASE("before the first scan there is no layer to tell of") {
  FleetMap fleet = fleet_map();
  fleet.tick({});
  CHECK_FALSE(fleet.diff({}, {}).has_value());
  CHECK_FALSE(fleet.encoded_layer().has_value());
  CHECK_FALSE(fleet.report().current.has_value());
}

TEST_CASE("a tick that changes something is one revision, and its diff makes copies equal") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 1)});
  const LayerId id = fleet.report().current->id;
  CHECK(id.origin == 7);
  Replica copy(id);
  follow(fleet, copy);
  tick(fleet, {floor_block({0, 0, 0}, 9), floor_block({1, 0, 0}, 2)});
  tick(fleet, {});
  follow(fleet, copy);
  const PublishingReport report = fleet.report();
  CHECK(report.current->revision == Revision{2});
  CHECK(copy.holdings().lowest({}) == Revision{2});
  CHECK(copy.digest().root() == report.current->digest);
  CHECK(report.traffic.packets == 2);
  CHECK(report.traffic.bytes_of_last_tick == 0);
}

TEST_CASE("what the sender rules hold back is published after a rest") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 1), one_free_voxel({5, 5, 5})});
  CHECK(fleet.report().blocks_held_back == 1);
  tick(fleet, {});
  tick(fleet, {});
  CHECK(fleet.report().blocks_held_back == 1);
  tick(fleet, {});
  CHECK(fleet.report().blocks_held_back == 0);
  CHECK(fleet.report().current->revision == Revision{2});
}

TEST_CASE("a flush publishes what is held back in all layers, and says in how many blocks") {
  FleetMap fleet = fleet_map();
  CHECK_FALSE(fleet.flush().has_value());
  tick(fleet, {one_free_voxel({5, 5, 5})});
  const std::vector<LayerChanges> next{changes_of(
      {floor_block({0, 0, 0}, 1), one_free_voxel({5, 5, 5}), one_free_voxel({6, 5, 5})}, 1)};
  fleet.tick(next);
  const auto flushed = fleet.flush();
  REQUIRE(flushed.has_value());
  CHECK(flushed->blocks == 3);
  CHECK(flushed->revision == Revision{2});
  CHECK(flushed->layer == fleet.report().current->id);
  CHECK(fleet.report().blocks_held_back == 0);
  Replica copy(flushed->layer);
  follow(fleet, copy);
  CHECK(copy.codes(ordinal_of({6, 5, 5})) == one_free_voxel({6, 5, 5}).codes);
  CHECK(fleet.flush()->blocks == 0);
  CHECK(fleet.flush()->revision == Revision{2});
}

TEST_CASE("without sender rules nothing waits") {
  FleetMap fleet = fleet_map({false, false});
  tick(fleet, {one_free_voxel({5, 5, 5})});
  CHECK(fleet.report().blocks_held_back == 0);
  CHECK(fleet.report().current->revision == Revision{1});
}

TEST_CASE("an earlier mission's layer is ground where this robot knows nothing, and only there") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 15)});
  CHECK(fleet.ground(question_at(1))->validity == Validity::kUnknown);
  const auto loaded =
      fleet.load(earlier_layer({floor_block({0, 0, 0}, 1), floor_block({1, 0, 0}, 1)}));
  REQUIRE(loaded.has_value());
  CHECK(loaded->voxels.occupied == 128);
  CHECK(loaded->voxels.free == 896);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
  CHECK(fleet.ground(question_at(0))->validity == Validity::kTooHard);
  CHECK(fleet.report().layers_loaded == 1);
}

TEST_CASE("a layer loaded before the first scan lies where its pose says") {
  FleetMap fleet = fleet_map();
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)})).has_value());
  tick(fleet, {floor_block({0, 0, 0}, 1)});
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
}

TEST_CASE("loading a layer twice is refused") {
  FleetMap fleet = fleet_map();
  REQUIRE(fleet.load(earlier_layer({floor_block({0, 0, 0}, 1)})).has_value());
  const auto again = fleet.load(earlier_layer({floor_block({0, 0, 0}, 1)}));
  REQUIRE_FALSE(again.has_value());
  CHECK(again.error().find("already") != std::string::npos);
}

TEST_CASE("a new frame epoch begins a layer of its own, and the one before still counts") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({1, 0, 0}, 1)});
  const LayerId first = fleet.report().current->id;
  const std::vector<LayerChanges> changes{changes_of({floor_block({0, 0, 0}, 1)}, 1)};
  fleet.tick(changes);
  const LayerId second = fleet.report().current->id;
  CHECK(second.number == first.number + 1);
  CHECK(second.incarnation != first.incarnation);
  CHECK(fleet.ground(question_at(0))->validity == Validity::kTraversable);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
}

TEST_CASE("what is held back in a layer that a new epoch froze is published after a rest too") {
  FleetMap fleet = fleet_map();
  tick(fleet, {one_free_voxel({5, 5, 5})});
  const std::vector<LayerChanges> next{changes_of({floor_block({0, 0, 0}, 1)}, 1)};
  fleet.tick(next);
  CHECK(fleet.report().traffic.bytes_of_last_tick > 0);
  CHECK(fleet.report().blocks_held_back == 1);
  const std::vector<LayerChanges> nothing{changes_of({}, 1)};
  for (int ticks = 0; ticks < 3; ++ticks) fleet.tick(nothing);
  CHECK(fleet.report().blocks_held_back == 0);
  fleet.tick(nothing);
  CHECK(fleet.report().traffic.bytes_of_last_tick == 0);
}

TEST_CASE(
    "the merge-map lies around the newest layer, however far its frame is from the one before") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 1)});
  LayerChanges next = changes_of({floor_block({0, 0, 0}, 1)}, 1);
  next.origin = {};
  fleet.tick({&next, 1});
  GroundQuestion question = question_at(0);
  question.T_map_base.translation -= kFarOrigin.position_map(0.1);
  CHECK(fleet.ground(question)->validity == Validity::kTraversable);
}

TEST_CASE("a correction of the map frame moves the layers of others, not this robot's own") {
  FleetMap fleet = fleet_map();
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)})).has_value());
  LayerChanges changes = changes_of({floor_block({0, 0, 0}, 1)});
  changes.T_fleet_map.translation = {0.0, 0.8, 0.0};
  fleet.tick({&changes, 1});
  CHECK(fleet.ground(question_at(0))->validity == Validity::kTraversable);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kUnknown);
  GroundQuestion moved = question_at(1);
  moved.T_map_base.translation.y() -= 0.8;
  CHECK(fleet.ground(moved)->validity == Validity::kTraversable);
}

}  // namespace warren
