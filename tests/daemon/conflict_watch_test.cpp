// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/conflict_watch.hpp"

#include <doctest/doctest.h>

#include "tests/daemon/small_fleet.hpp"

namespace warren {

using namespace test;

namespace {

std::vector<CodedBlock> floor_of(std::int32_t blocks) {
  std::vector<CodedBlock> floor;
  for (std::int32_t x = 0; x < blocks; ++x) floor.push_back(floor_block({x, 0, 0}, 1));
  return floor;
}

// Of one whole round.
std::optional<double> score_of(ConflictWatch& watch, FleetMap& fleet, const LayerId& layer) {
  for (int i = 0; i < 100; ++i) {
    if (watch.advance(fleet) == layer) return watch.score(layer);
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE(
    "a layer that lies where it belongs does not contradict the own map, one that does not does") {
  FleetMap fleet = fleet_map();
  tick(fleet, floor_of(16));
  fleet.flush();
  const LayerId id = fleet.load(earlier_layer(floor_of(16)), "old.layer")->id;
  ConflictWatch watch;
  CHECK_FALSE(watch.score(id).has_value());
  CHECK(score_of(watch, fleet, id) == 0.0);
  // Half a metre up, every obstacle of it stands in the free space above our floor.
  REQUIRE(fleet.loaded().move(id, {{0.0, 0.0, 0.5}, 0.0}).has_value());
  CHECK(score_of(watch, fleet, id) == 1.0);
  // Half of it is where we have a floor, the other half where we know nothing.
  REQUIRE(fleet.loaded().move(id, {{6.4, 0.0, 0.0}, 0.0}).has_value());
  CHECK(score_of(watch, fleet, id) == 0.0);
}

TEST_CASE("a layer a little off lies askew, one far off misleads") {
  CHECK(level_of(0.02) == ConflictLevel::kAligned);
  CHECK(level_of(0.10) == ConflictLevel::kAskew);
  CHECK(level_of(0.14) == ConflictLevel::kAskew);
  CHECK(level_of(0.25) == ConflictLevel::kMisleading);
  CHECK(level_of(0.40) == ConflictLevel::kMisleading);
}

TEST_CASE("where both know too little of the same places there is no score") {
  FleetMap fleet = fleet_map();
  ConflictWatch watch;
  CHECK_FALSE(watch.advance(fleet).has_value());
  tick(fleet, floor_of(2));
  fleet.flush();
  const LayerId id = fleet.load(earlier_layer(floor_of(16)), "old.layer")->id;
  CHECK_FALSE(score_of(watch, fleet, id).has_value());
  CHECK_FALSE(watch.score(id).has_value());
}

TEST_CASE("large layers are looked at a part at a time, and all of them in turn") {
  FleetMap fleet = fleet_map();
  tick(fleet, floor_of(300));
  fleet.flush();
  const LayerId id = fleet.load(earlier_layer(floor_of(300)), "old.layer")->id;
  Replica second(LayerId{99, 2, 6}, kDefaultResolution);
  second.publish(floor_of(16));
  second.pose() = fleet.loaded().replica(id)->pose();
  const LayerId other = fleet.load(std::move(second), "second.layer")->id;
  ConflictWatch watch;
  CHECK_FALSE(watch.advance(fleet).has_value());
  CHECK(score_of(watch, fleet, id) == 0.0);
  CHECK(watch.advance(fleet) == other);
  CHECK(watch.score(other) == 0.0);
}

}  // namespace warren
