// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/loaded_layers.hpp"

#include <numbers>

#include <doctest/doctest.h>

#include "tests/daemon/small_fleet.hpp"

namespace warren {

using namespace test;

namespace {

using Voxels = std::vector<std::pair<std::uint64_t, VoxelCode>>;

Voxels merged(FleetMap& fleet) {
  Voxels voxels;
  fleet.merged_snapshot()->for_each_known([&](const VoxelKey& key, VoxelCode code, SourceNumber) {
    voxels.emplace_back(morton_of(key), code);
  });
  return voxels;
}

Replica far_layer(const Eigen::Vector3d& origin_fleet) {
  Replica layer(LayerId{99, 2, 6}, kDefaultResolution);
  layer.publish({{floor_block({0, 0, 0}, 1)}});
  layer.pose().update_origin({1, 99, {origin_fleet, Eigen::Quaterniond::Identity()}});
  return layer;
}

}  // namespace

TEST_CASE(
    "a layer retracted leaves the merge-map as it was before the load, until it is restored") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 15)});
  const Voxels before = merged(fleet);
  const auto loaded =
      fleet.load(earlier_layer({floor_block({0, 0, 1}, 1), floor_block({1, 0, 0}, 1)}), "old.bt");
  REQUIRE(loaded.has_value());
  CHECK(loaded->file == "old.bt");
  CHECK_FALSE(loaded->retracted);
  const Voxels with_it = merged(fleet);
  CHECK(with_it.size() == before.size() + 1024);
  const auto retracted = fleet.loaded().retract(loaded->id);
  REQUIRE(retracted.has_value());
  CHECK(retracted->retracted);
  CHECK(fleet.report().loaded.front().retracted);
  CHECK(merged(fleet) == before);
  REQUIRE(fleet.loaded().retract(loaded->id).has_value());
  CHECK(merged(fleet) == before);
  CHECK_FALSE(fleet.loaded().restore(loaded->id)->retracted);
  CHECK(merged(fleet) == with_it);
}

TEST_CASE("a layer is moved from where its pose puts it, and back, also while it is retracted") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({5, 5, 5}, 1)});
  const LayerId id = fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.bt")->id;
  const Voxels as_loaded = merged(fleet);
  const auto moved = fleet.loaded().move(id, {{0.8, 0.0, 0.0}, 0.0});
  REQUIRE(moved.has_value());
  const Eigen::Vector3d origin = kFarOrigin.position_map(0.1);
  CHECK(moved->T_fleet_layer.translation.isApprox(origin + Eigen::Vector3d(0.8, 0.0, 0.0)));
  CHECK(fleet.ground(question_at(1))->validity == Validity::kUnknown);
  CHECK(fleet.ground(question_at(2))->validity == Validity::kTraversable);
  // In place of the move before, about the layer's own origin: block (1, 0, 0) comes to (0, 1, 0).
  REQUIRE(fleet.loaded().retract(id).has_value());
  REQUIRE(fleet.loaded().move(id, {{0.8, 0.0, 0.0}, std::numbers::pi / 2}).has_value());
  CHECK(fleet.ground(question_at(0))->validity == Validity::kUnknown);
  REQUIRE(fleet.loaded().restore(id).has_value());
  GroundQuestion turned = question_at(0);
  turned.T_map_base.translation.y() += 0.8;
  CHECK(fleet.ground(turned)->validity == Validity::kTraversable);
  REQUIRE(fleet.loaded().move(id, {}).has_value());
  CHECK(merged(fleet) == as_loaded);
}

TEST_CASE("a correction of the map frame keeps what the operator did to a layer") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({5, 5, 5}, 1)});
  const LayerId id = fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.bt")->id;
  REQUIRE(fleet.loaded().move(id, {{0.8, 0.0, 0.0}, 0.0}).has_value());
  LayerChanges changes = changes_of({});
  changes.T_fleet_map.translation = {0.8, 0.0, 0.0};
  fleet.tick({&changes, 1});
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
  REQUIRE(fleet.loaded().retract(id).has_value());
  changes.T_fleet_map.translation = {0.0, 0.0, 0.0};
  fleet.tick({&changes, 1});
  CHECK(fleet.ground(question_at(2))->validity == Validity::kUnknown);
  REQUIRE(fleet.loaded().restore(id).has_value());
  CHECK(fleet.ground(question_at(2))->validity == Validity::kTraversable);
}

TEST_CASE("a layer is shown if both this node and the fleet's orders allow it") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 15)});
  const Voxels before = merged(fleet);
  const LayerId id = fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.bt")->id;
  const Voxels with_it = merged(fleet);
  fleet.loaded().set_retracted_by_fleet(id, true);
  CHECK(merged(fleet) == before);
  CHECK(fleet.loaded().find(id)->retracted);
  CHECK(fleet.loaded().find(id)->retracted_by_fleet);
  REQUIRE(fleet.loaded().restore(id).has_value());
  CHECK(merged(fleet) == before);
  REQUIRE(fleet.loaded().retract(id).has_value());
  fleet.loaded().set_retracted_by_fleet(id, false);
  CHECK(merged(fleet) == before);
  CHECK_FALSE(fleet.loaded().find(id)->retracted_by_fleet);
  REQUIRE(fleet.loaded().restore(id).has_value());
  CHECK(merged(fleet) == with_it);
  fleet.loaded().set_retracted_by_fleet({1, 2, 3}, true);
  CHECK(merged(fleet) == with_it);
}

TEST_CASE("only what is loaded can be retracted, restored or moved") {
  FleetMap fleet = fleet_map();
  for (const auto& result : {fleet.loaded().retract({1, 2, 3}), fleet.loaded().restore({1, 2, 3}),
                             fleet.loaded().move({1, 2, 3}, {})}) {
    REQUIRE_FALSE(result.has_value());
    CHECK(result.error().find("no such layer") != std::string::npos);
  }
}

TEST_CASE("a layer beyond the merge-map's reach is refused with a reason, and counted") {
  FleetMap fleet = fleet_map();
  // The map frame's own origin is a long way from the layer's, whose pose by itself is a good one.
  LayerChanges changes = changes_of({floor_block({0, 0, 0}, 1)});
  changes.origin = {std::int64_t{1} << 40, 0, 0};
  fleet.tick({&changes, 1});
  const std::uint64_t before = fleet.report().poses_refused;
  const auto refused = fleet.load(far_layer({0.0, 0.0, 0.0}), "far.layer");
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().find("million km") != std::string::npos);
  CHECK(fleet.report().poses_refused == before + 1);
  CHECK(fleet.report().loaded.empty());
}

TEST_CASE("a layer that comes to lie beyond reach is left out and told, until it is near again") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({5, 5, 5}, 1)});
  const Voxels before = merged(fleet);
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.bt").has_value());
  LayerChanges changes = changes_of({});
  const auto correct = [&](double x_m) {
    changes.T_fleet_map.translation = {x_m, 0.0, 0.0};
    fleet.tick({&changes, 1});
    fleet.tick({&changes, 1});
  };
  const std::uint64_t refused = fleet.report().poses_refused;
  correct(2e9);
  CHECK(merged(fleet) == before);
  CHECK(fleet.report().loaded.front().out_of_reach);
  // The loaded layer's, and the own layer's, whose word of 2e9 m is no pose either.
  CHECK(fleet.report().poses_refused == refused + 2);
  correct(0.0);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
  CHECK_FALSE(fleet.report().loaded.front().out_of_reach);
  CHECK(fleet.report().poses_refused == refused + 2);
}

TEST_CASE("a move beyond reach is refused and changes nothing") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({5, 5, 5}, 1)});
  const LayerId id = fleet.load(earlier_layer({floor_block({1, 0, 0}, 1)}), "old.bt")->id;
  CHECK_FALSE(fleet.loaded().move(id, {{2e9, 0.0, 0.0}, 0.0}).has_value());
  CHECK(fleet.report().poses_refused == 1);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
}

TEST_CASE("an own layer that lies beyond the newest one's reach is left out of the merge-map") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 1)});
  LayerChanges next = changes_of({floor_block({0, 0, 0}, 1)}, 1);
  next.origin = {std::int64_t{1} << 40, 0, 0};
  fleet.tick({&next, 1});
  CHECK(merged(fleet).size() == 512);
  CHECK(fleet.report().poses_refused > 0);
}

TEST_CASE("a copy counts once its origin has said where it lies, and follows what it says") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({5, 5, 5}, 1)});
  Replica copy(LayerId{99, 2, 6}, kDefaultResolution);
  const auto added = fleet.loaded().add_copy(copy);
  REQUIRE(added.has_value());
  CHECK(added->unplaced);
  CHECK_FALSE(fleet.loaded().add_copy(copy).has_value());
  Replica writer(copy.id(), kDefaultResolution);
  const auto write = [&](const BlockKey& key) {
    const Revision before = writer.holdings().at(0);
    writer.publish({{floor_block(key, 1)}});
    const auto packet = writer.encode({{}, before});
    REQUIRE(copy.apply(copy.id(), packet->bytes) == ApplyResult::kApplied);
  };
  write({0, 0, 0});
  CHECK(fleet.ground(question_at(0))->validity == Validity::kUnknown);
  const Eigen::Vector3d origin = kFarOrigin.position_map(0.1);
  copy.pose().update_origin({1, 99, {origin, Eigen::Quaterniond::Identity()}});
  fleet.place_others();
  CHECK(fleet.ground(question_at(0))->validity == Validity::kTraversable);
  CHECK(fleet.ground(question_at(1))->validity == Validity::kUnknown);
  write({1, 0, 0});
  CHECK(fleet.ground(question_at(1))->validity == Validity::kTraversable);
  copy.pose().update_origin(
      {2, 99, {origin + Eigen::Vector3d(0.8, 0.0, 0.0), Eigen::Quaterniond::Identity()}});
  fleet.place_others();
  CHECK(fleet.ground(question_at(0))->validity == Validity::kUnknown);
  CHECK(fleet.ground(question_at(2))->validity == Validity::kTraversable);

  REQUIRE(fleet.loaded().retract(copy.id()).has_value());
  CHECK(fleet.ground(question_at(1))->validity == Validity::kUnknown);
  write({2, 0, 0});
  CHECK(fleet.ground(question_at(3))->validity == Validity::kUnknown);
  const auto restored = fleet.loaded().restore(copy.id());
  REQUIRE(restored.has_value());
  CHECK(restored->voxels.occupied == 3 * 64);
  CHECK(fleet.ground(question_at(3))->validity == Validity::kTraversable);
  CHECK(fleet.loaded().find(copy.id())->file.empty());
  CHECK(fleet.loaded().list().empty());
}

TEST_CASE("a copy that lies beyond reach at first comes in when it is moved within it") {
  FleetMap fleet = fleet_map();
  LayerChanges changes = changes_of({floor_block({0, 0, 0}, 1)});
  changes.origin = {std::int64_t{1} << 40, 0, 0};
  fleet.tick({&changes, 1});
  Replica copy = far_layer(kFarOrigin.position_map(0.1) + Eigen::Vector3d(4.0, 0.0, 0.0));
  const auto added = fleet.loaded().add_copy(copy);
  REQUIRE(added.has_value());
  CHECK(added->out_of_reach);
  const auto own_only = merged(fleet).size();
  changes.origin = kFarOrigin;
  changes.number = 1;
  fleet.tick({&changes, 1});
  CHECK_FALSE(fleet.loaded().find(copy.id())->out_of_reach);
  CHECK(merged(fleet).size() > own_only);
}

}  // namespace warren
