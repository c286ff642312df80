// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/voxel/self_map.hpp"

using namespace warren;

namespace {

constexpr Point3f kOrigin{0.05F, 0.05F, 0.05F};

Point3f centre_of(const VoxelKey& key) {
  const auto metres = [](std::int32_t k) { return (static_cast<float>(k) + 0.5F) * 0.1F; };
  return {metres(key.x), metres(key.y), metres(key.z)};
}

void hit(SelfMap& map, const std::vector<VoxelKey>& keys) {
  std::vector<Point3f> points;
  for (const VoxelKey& key : keys) points.push_back(centre_of(key));
  map.integrate({kOrigin, points, std::nullopt, {}});
}

void fuse(SelfMap& map, const VoxelKey& key, float cost) {
  const VoxelCost measured{key, cost, 1.0F};
  map.fuse_costs({&measured, 1});
}

}  // namespace

TEST_CASE("only an occupied voxel that was judged has a cost") {
  SelfMap map({});
  hit(map, {{10, 0, 0}, {10, 4, 0}});
  fuse(map, {10, 0, 0}, 0.25F);
  REQUIRE(map.cost({10, 0, 0}));
  CHECK(*map.cost({10, 0, 0}) == doctest::Approx(0.25).epsilon(1e-4));
  CHECK_FALSE(map.cost({10, 4, 0}));   // never judged
  CHECK_FALSE(map.cost({5, 0, 0}));    // free
  CHECK_FALSE(map.cost({500, 0, 0}));  // unknown
}

TEST_CASE("costs of voxels that were not hit are counted and leave nothing behind") {
  SelfMap map({});
  hit(map, {{10, 0, 0}});
  const std::vector<VoxelCost> costs{
      {{300, 0, 0}, 0.5F, 1.0F}, {{10, 1, 0}, 0.5F, 1.0F}, {{10, 0, 0}, 0.5F, 1.0F}};
  const CostFusionReport report = map.fuse_costs(costs);
  CHECK(report.voxels_without_hit == 2);
  CHECK(report.voxels_fused == 1);
  CHECK(report.voxels_changed == 1);
  CHECK(map.state(VoxelKey{300, 0, 0}) == VoxelState::kUnknown);
}

TEST_CASE("a change of cost alone marks its block as changed") {
  SelfMap map({});
  for (int i = 0; i < 60; ++i) hit(map, {{10, 0, 0}});  // at the clamp: more hits change nothing
  fuse(map, {10, 0, 0}, 0.0F);
  const std::uint32_t before = map.cursor();
  hit(map, {{10, 0, 0}});
  CHECK(map.blocks_changed_since(before).empty());
  fuse(map, {10, 0, 0}, 0.9F);
  CHECK(map.blocks_changed_since(before) == std::vector<BlockKey>{{1, 0, 0}});
  const std::uint32_t settled = map.cursor();
  hit(map, {{10, 0, 0}});
  fuse(map, {10, 0, 0}, *map.cost({10, 0, 0}));
  CHECK(map.blocks_changed_since(settled).empty());
}

TEST_CASE("what has gone takes its cost along") {
  SelfMap map({});
  const VoxelKey key{10, 0, 0};
  hit(map, {key});
  fuse(map, key, 0.9F);
  const std::size_t with_cost = map.memory_bytes();
  for (int i = 0; i < 40; ++i) hit(map, {{20, 0, 0}});  // rays pass through
  REQUIRE(map.state(key) == VoxelState::kFree);
  CHECK_FALSE(map.cost(key));
  for (int i = 0; i < 5; ++i) hit(map, {key});
  REQUIRE(map.state(key) == VoxelState::kOccupied);
  CHECK_FALSE(map.cost(key));  // not the cost of what stood there before
  fuse(map, key, 0.1F);
  CHECK(*map.cost(key) == doctest::Approx(0.1).epsilon(1e-3));
  CHECK(map.memory_bytes() <= with_cost + 4096);
}

TEST_CASE("a voxel that looks free for a moment keeps its cost") {
  SelfMap map({0.1, SensorModel{}, false, {}});
  const VoxelKey key{10, 0, 0};
  hit(map, {key});
  fuse(map, key, 0.5F);
  hit(map, {{20, 0, 0}});
  hit(map, {{20, 0, 0}});
  hit(map, {{20, 0, 0}});
  REQUIRE(map.state(key) == VoxelState::kFree);
  CHECK_FALSE(map.cost(key));
  hit(map, {key});
  hit(map, {key});
  REQUIRE(map.state(key) == VoxelState::kOccupied);
  CHECK(map.cost(key));
}

TEST_CASE("a copy's costs are its own") {
  SelfMap map({});
  hit(map, {{10, 0, 0}});
  fuse(map, {10, 0, 0}, 0.2F);
  const SelfMap copy = map;
  hit(map, {{10, 0, 0}});
  fuse(map, {10, 0, 0}, 1.0F);
  CHECK(*copy.cost({10, 0, 0}) == doctest::Approx(0.2).epsilon(1e-3));
  CHECK(*map.cost({10, 0, 0}) > 0.5F);
}

TEST_CASE("costs are kept as a plain table would keep them") {
  CHECK(rc::check("as a table", [] {
    SelfMap map({});
    std::map<VoxelKey, FusedCost> table;
    const CostFusion fusion{CostFusionConfig{}};
    const auto scans = *rc::gen::inRange(1, 12);
    for (int scan = 0; scan < scans; ++scan) {
      // On a wall: no ray passes the end of another.
      std::vector<VoxelKey> keys;
      for (int i = *rc::gen::inRange(1, 40); i > 0; --i) {
        keys.push_back({30, *rc::gen::inRange(-20, 20), *rc::gen::inRange(-20, 20)});
      }
      std::sort(keys.begin(), keys.end());
      keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
      hit(map, keys);
      std::vector<VoxelCost> costs;
      for (const VoxelKey& key : keys) {
        costs.push_back({key, static_cast<float>(*rc::gen::inRange(0, 101)) / 100.0F, 1.0F});
        const auto found = table.find(key);
        table[key] = found == table.end() ? fusion.first(costs.back())
                                          : fusion.next(found->second, costs.back(), 0.9);
      }
      map.fuse_costs(costs);
    }
    std::size_t costed = 0;
    map.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState, float) {
      const auto cost = map.fused_cost(key);
      if (!cost) return;
      ++costed;
      RC_ASSERT(table.at(key) == *cost);
    });
    RC_ASSERT(costed == table.size());
  }));
}
