// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <random>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/voxel/self_map.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;

namespace {

std::map<BlockKey, BlockState> states_of(const SelfMap& map) {
  std::map<BlockKey, BlockState> states;
  for (const BlockKey& key : map.blocks_changed_since(0)) states[key] = *map.export_block(key);
  return states;
}

SelfMap copy_by_states(const SelfMap& map) {
  SelfMap copy(map.config());
  for (const auto& [key, state] : states_of(map)) REQUIRE(copy.import_block(state));
  copy.import_cursor(map.cursor());
  return copy;
}

std::vector<VoxelCost> some_costs(const SelfMap& map, std::mt19937& random) {
  std::vector<VoxelCost> costs;
  map.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float) {
    if (state != VoxelState::kOccupied || random() % 3 != 0) return;
    costs.push_back({key, static_cast<float>(random() % 100) / 100.0F, 0.7F});
  });
  return costs;
}

// A walk with ground, often enough through the same place for blocks to become free throughout.
SelfMap walked(std::uint32_t seed, int scans) {
  std::mt19937 random(seed);
  SelfMap map(SelfMapConfig{});
  test::Room room;
  room.column_x_m = static_cast<float>(seed % 5) - 2.0F;
  for (const auto& scan : test::walk_through_room(room, test::Lidar{12, 60}, scans)) {
    map.integrate(scan.view());
    map.fuse_costs(some_costs(map, random));
  }
  return map;
}

BlockState some_block_with_costs(const SelfMap& map) {
  for (const auto& [key, state] : states_of(map)) {
    if (!state.costs.empty()) return state;
  }
  FAIL("no block has costs");
  return {};
}

}  // namespace

TEST_CASE("a map made of exported blocks is the same map, and goes on the same way") {
  CHECK(rc::check("states and futures are equal", [] {
    const auto seed = *rc::gen::inRange(0U, 1000U);
    SelfMap map = walked(seed, *rc::gen::inRange(1, 25));
    SelfMap copy = copy_by_states(map);
    RC_ASSERT(states_of(copy) == states_of(map));
    RC_ASSERT(copy.cursor() == map.cursor());

    const auto more = test::scan_room(test::Room{}, test::Lidar{}, {1.0F, -1.0F, 0.2F}, seed);
    RC_ASSERT(copy.integrate(more.view()).blocks_changed ==
              map.integrate(more.view()).blocks_changed);
    std::mt19937 random(seed);
    const std::vector<VoxelCost> costs = some_costs(map, random);
    map.fuse_costs(costs);
    copy.fuse_costs(costs);
    RC_ASSERT(states_of(copy) == states_of(map));
  }));
}

TEST_CASE("a block that is free throughout needs no memory after an import either") {
  SelfMap map(SelfMapConfig{});
  const auto scan = test::scan_room(test::Room{}, test::Lidar{}, {-3.0F, -2.0F, 0.1F}, 1);
  for (int i = 0; i < 20; ++i) map.integrate(scan.view());
  REQUIRE(map.blocks().block_count() < map.counts().blocks);
  CHECK(copy_by_states(map).blocks().block_count() == map.blocks().block_count());
}

TEST_CASE("nothing is exported where nothing is known") {
  CHECK_FALSE(SelfMap(SelfMapConfig{}).export_block({0, 0, 0}));
  CHECK_FALSE(walked(1, 1).export_block({500, 0, 0}));
}

TEST_CASE("a state that no map could have exported is refused") {
  const BlockState sound = some_block_with_costs(walked(3, 5));
  const auto refused = [&](auto&& spoil) {
    BlockState state = sound;
    spoil(state);
    SelfMap map(SelfMapConfig{});
    const bool taken = map.import_block(state);
    CHECK(map.counts().blocks == (taken ? 1 : 0));
    return !taken;
  };
  CHECK_FALSE(refused([](BlockState&) {}));
  CHECK(refused([](BlockState& state) { state.values.pop_back(); }));
  CHECK(refused([](BlockState& state) { state.costs.push_back({}); }));
  CHECK(refused([](BlockState& state) { state.changed_at = 0; }));
  CHECK(refused([](BlockState& state) { state.key.x = 4096; }));
  CHECK(refused([](BlockState& state) { state.values[0] = -32768; }));
  CHECK(refused([](BlockState& state) {
    for (auto& value : state.values) value = static_cast<std::int16_t>(-value - 1);
  }));
  CHECK(refused([](BlockState& state) { state.occupied = state.clamped_free = state.known; }));
  CHECK(
      refused([](BlockState& state) { state = BlockState{state.key, 1, {}, {}, {}, {}, {}, {}}; }));
}

TEST_CASE("a block is not imported over one that is known") {
  SelfMap map = walked(3, 2);
  const auto before = states_of(map);
  CHECK_FALSE(map.import_block(before.begin()->second));
  CHECK(states_of(map) == before);
}
