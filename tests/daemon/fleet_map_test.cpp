// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet_map.hpp"

#include <doctest/doctest.h>

#include "tests/daemon/small_fleet.hpp"

namespace warren {

using namespace test;
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
  Replica copy(id, kDefaultResolution);
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
  Replica copy(flushed->layer, kDefaultResolution);
  follow(fleet, copy);
  CHECK(copy.codes(ordinal_of({6, 5, 5})) == one_free_voxel({6, 5, 5}).codes);
  CHECK(fleet.flush()->blocks == 0);
  CHECK(fleet.flush()->revision == Revision{2});
}

TEST_CASE("regions that nothing changes are packed, a few at each tick, and wake when changed") {
  constexpr std::int32_t kRegions = 20;
  FleetMap fleet = fleet_map({}, 3);
  std::vector<CodedBlock> blocks;
  for (std::int32_t x = 0; x < kRegions; ++x) blocks.push_back(floor_block({8 * x, 0, 0}, 1));
  tick(fleet, blocks);
  const PublishingReport awake = fleet.report();
  CHECK(awake.memory.regions == kRegions);
  for (int ticks = 0; ticks < 2; ++ticks) tick(fleet, {});
  CHECK(fleet.report().memory.regions_at_rest == 0);
  for (const std::size_t at_rest : {8U, 16U, 20U, 20U}) {
    tick(fleet, {});
    CHECK(fleet.report().memory.regions_at_rest == at_rest);
  }
  const PublishingReport report = fleet.report();
  CHECK(report.current->digest == awake.current->digest);
  CHECK(report.memory.own_layers_bytes < awake.memory.own_layers_bytes);
  CHECK(report.memory.at_rest_bytes > 0);
  tick(fleet, {floor_block({0, 0, 0}, 9)});
  CHECK(fleet.report().memory.regions_at_rest == kRegions - 1);
  Replica copy(report.current->id, kDefaultResolution);
  follow(fleet, copy);
  CHECK(copy.digest().root() == fleet.report().current->digest);
}

TEST_CASE("frozen and loaded layers are packed too, and read as before") {
  FleetMap fleet = fleet_map({}, 3);
  tick(fleet, {floor_block({0, 0, 0}, 15)});
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.layer").has_value());
  LayerChanges next = changes_of({floor_block({9, 0, 0}, 1)}, 1);
  for (int ticks = 0; ticks < 8; ++ticks) {
    fleet.tick({&next, 1});
    next.blocks = {floor_block({9, 0, 0}, static_cast<CostCode>(1 + 4 * (ticks % 2)))};
  }
  const PublishingReport report = fleet.report();
  CHECK(report.memory.regions == 3);
  CHECK(report.memory.regions_at_rest == 2);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
  CHECK(fleet.ground(question_at(0))->validity == Validity::kTooHard);
}

TEST_CASE("the memory told is that of own layers, loaded ones and the merge-map") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 1)});
  const LayerMemory own = fleet.report().memory;
  CHECK(own.own_layers_bytes > 0);
  CHECK(own.loaded_layers_bytes == 0);
  CHECK(own.merge_map_bytes > 0);
  tick(fleet, {one_free_voxel({1, 0, 0})});
  const LayerMemory holds_back = fleet.report().memory;
  CHECK(holds_back.own_layers_bytes > own.own_layers_bytes);
  CHECK(holds_back.merge_map_bytes > own.merge_map_bytes);
  REQUIRE(fleet.load(earlier_layer({floor_block({2, 0, 0}, 1)}), "old.layer").has_value());
  const LayerMemory loaded = fleet.report().memory;
  CHECK(loaded.own_layers_bytes == holds_back.own_layers_bytes);
  CHECK(loaded.loaded_layers_bytes > 0);
  CHECK(loaded.merge_map_bytes > holds_back.merge_map_bytes);
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
  const auto loaded = fleet.load(
      earlier_layer({floor_block({0, 0, 0}, 1), floor_block({1, 0, 0}, 1)}), "old.layer");
  REQUIRE(loaded.has_value());
  CHECK(loaded->voxels.occupied == 128);
  CHECK(loaded->voxels.free == 896);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
  CHECK(fleet.ground(question_at(0))->validity == Validity::kTooHard);
  CHECK(fleet.report().loaded.size() == 1);
}

TEST_CASE("a layer loaded before the first scan lies where its pose says") {
  FleetMap fleet = fleet_map();
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.layer").has_value());
  tick(fleet, {floor_block({0, 0, 0}, 1)});
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
}

TEST_CASE("loading a layer twice is refused") {
  FleetMap fleet = fleet_map();
  REQUIRE(fleet.load(earlier_layer({floor_block({0, 0, 0}, 1)}), "old.layer").has_value());
  const auto again = fleet.load(earlier_layer({floor_block({0, 0, 0}, 1)}), "old.layer");
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
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.layer").has_value());
  LayerChanges changes = changes_of({floor_block({0, 0, 0}, 1)});
  changes.T_fleet_map.translation = {0.0, 0.8, 0.0};
  fleet.tick({&changes, 1});
  CHECK(fleet.ground(question_at(0))->validity == Validity::kTraversable);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kUnknown);
  GroundQuestion moved = question_at(1);
  moved.T_map_base.translation.y() -= 0.8;
  CHECK(fleet.ground(moved)->validity == Validity::kTraversable);
}

TEST_CASE(
    "the operator's word on an own layer moves this robot in the fleet, and others around it") {
  FleetMap fleet = fleet_map();
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.layer").has_value());
  LayerChanges changes = changes_of({floor_block({0, 0, 0}, 1)});
  changes.position_map = kFarOrigin.position_map(0.1) + Eigen::Vector3d(0.4, 0.4, 0.5);
  fleet.tick({&changes, 1});
  const LayerId id = fleet.report().current->id;
  const Eigen::Vector3d before = *fleet.position_fleet();
  CHECK(fleet.position_layer()->isApprox(Eigen::Vector3d(0.4, 0.4, 0.5), 1e-9));
  const Pose moved_by{{0.0, 0.8, 0.0}, Eigen::Quaterniond::Identity()};
  CHECK_FALSE(fleet.correct_own({id.origin, id.number + 1, 3}, {1, 9, moved_by}));
  REQUIRE(fleet.correct_own(id, {1, 9, moved_by}));
  CHECK_FALSE(fleet.correct_own(id, {1, 9, moved_by}));
  CHECK(fleet.position_fleet()->isApprox(before + Eigen::Vector3d(0.0, 0.8, 0.0)));
  CHECK(fleet.position_layer()->isApprox(Eigen::Vector3d(0.4, 0.4, 0.5), 1e-9));
  CHECK(fleet.ground(question_at(0))->validity == Validity::kTraversable);
  GroundQuestion of_other = question_at(1);
  of_other.T_map_base.translation.y() -= 0.8;
  CHECK(fleet.ground(of_other)->validity == Validity::kTraversable);
  // What this robot says of itself is another thing, and goes on.
  changes.T_fleet_map.translation = {0.0, 0.8, 0.0};
  fleet.tick({&changes, 1});
  CHECK(fleet.position_fleet()->isApprox(before + Eigen::Vector3d(0.0, 1.6, 0.0)));
}

}  // namespace warren
