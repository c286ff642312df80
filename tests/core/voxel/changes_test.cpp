// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <set>

#include <doctest/doctest.h>

#include "core/voxel/self_map.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;

namespace {

using Values = std::map<VoxelKey, float>;

Values values_of(const SelfMap& map) {
  Values values;
  map.for_each_known_voxel(
      {}, [&](const VoxelKey& key, VoxelState, float log_odds) { values[key] = log_odds; });
  return values;
}

std::set<BlockKey> blocks_that_differ(const Values& before, const Values& after) {
  std::set<BlockKey> blocks;
  for (const auto& [key, value] : after) {
    const auto old = before.find(key);
    if (old == before.end() || old->second != value) blocks.insert(block_of(key));
  }
  return blocks;
}

}  // namespace

TEST_CASE("blocks changed since a cursor are exactly those whose values differ") {
  SelfMap map(SelfMapConfig{});
  const auto walk = test::walk_through_room(test::Room{}, test::Lidar{}, 10);
  for (const auto& scan : walk) {
    const Values before = values_of(map);
    const std::uint32_t cursor = map.cursor();
    const IntegrationReport report = map.integrate(scan.view());
    const std::vector<BlockKey> changed = map.blocks_changed_since(cursor);
    CHECK(std::set<BlockKey>(changed.begin(), changed.end()) ==
          blocks_that_differ(before, values_of(map)));
    CHECK(changed.size() == report.blocks_changed);
  }
  CHECK(map.blocks_changed_since(map.cursor()).empty());
  CHECK(map.blocks_changed_since(0).size() == map.counts().blocks);
}

TEST_CASE("a scene that is saturated changes no more") {
  SelfMap map(SelfMapConfig{});
  const auto scan = test::scan_room(test::Room{}, test::Lidar{}, {-3.0F, -2.0F, 0.1F}, 1);
  for (int i = 0; i < 20; ++i) map.integrate(scan.view());
  CHECK(map.integrate(scan.view()).blocks_changed == 0);
}
