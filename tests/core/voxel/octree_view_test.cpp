// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/octree_view.hpp"

#include <map>
#include <set>

#include <doctest/doctest.h>

#include "tests/support/simulated_scans.hpp"

using namespace warren;

namespace {

SelfMap room_map() {
  SelfMap map(SelfMapConfig{});
  for (const auto& scan : test::walk_through_room(test::Room{}, test::Lidar{}, 8)) {
    map.integrate(scan.view());
  }
  return map;
}

std::map<VoxelKey, VoxelState> states_of(const SelfMap& map) {
  std::map<VoxelKey, VoxelState> states;
  map.for_each_known_voxel(
      {}, [&](const VoxelKey& key, VoxelState state, float) { states[key] = state; });
  return states;
}

VoxelKey cube_of(const VoxelKey& key, int level) {
  return {key.x >> level, key.y >> level, key.z >> level};
}

}  // namespace

TEST_CASE("the pruned leaves are the known voxels, each once") {
  const SelfMap map = room_map();
  std::map<VoxelKey, VoxelState> unpruned;
  std::size_t leaves = 0;
  OctreeView(map).for_each_leaf(0, [&](const OctreeLeaf& leaf) {
    ++leaves;
    const std::int32_t edge = 1 << leaf.level;
    for (std::int32_t i = 0; i < edge * edge * edge; ++i) {
      const VoxelKey key{leaf.low.x + i % edge, leaf.low.y + i / edge % edge,
                         leaf.low.z + i / edge / edge};
      CHECK(unpruned.emplace(key, leaf.state).second);
    }
  });
  CHECK(unpruned == states_of(map));
  CHECK(leaves < unpruned.size() / 3);
}

TEST_CASE("no eight leaves could be one") {
  const SelfMap map = room_map();
  std::map<std::pair<int, VoxelKey>, std::pair<int, std::set<VoxelState>>> siblings;
  OctreeView(map).for_each_leaf(0, [&](const OctreeLeaf& leaf) {
    auto& group = siblings[{leaf.level, cube_of(leaf.low, leaf.level + 1)}];
    ++group.first;
    group.second.insert(leaf.state);
  });
  for (const auto& [cube, group] : siblings) CHECK((group.first < 8 || group.second.size() > 1));
}

TEST_CASE("a coarse cube is occupied if any voxel is, else free if any is") {
  const SelfMap map = room_map();
  const OctreeView view(map);
  const auto states = states_of(map);
  for (const int level : {0, 1, 2, 3, 4, 5, 6, 7, 10, 16}) {
    std::map<VoxelKey, VoxelState> wanted;
    for (const auto& [key, state] : states) {
      VoxelState& cube = wanted[cube_of(key, level)];
      cube = std::max(cube, state);
    }
    std::map<VoxelKey, VoxelState> coarse;
    view.for_each_leaf(level, [&](const OctreeLeaf& leaf) {
      CHECK(leaf.level >= level);
      if (leaf.level == level) coarse[cube_of(leaf.low, level)] = leaf.state;
    });
    for (const auto& [cube, state] : coarse) CHECK(wanted.at(cube) == state);
    int looked = 0;
    for (const auto& [key, state] : states) {
      if (++looked % 97 == 0) CHECK(view.state(key, level) == wanted[cube_of(key, level)]);
    }
  }
}

TEST_CASE("an empty map has no leaves and is unknown at every level") {
  const SelfMap map(SelfMapConfig{});
  const OctreeView view(map);
  view.for_each_leaf(0, [](const OctreeLeaf&) { FAIL("a leaf in an empty map"); });
  for (int level = 0; level <= OctreeView::kRootLevel; ++level) {
    CHECK(view.state({0, 0, 0}, level) == VoxelState::kUnknown);
  }
}
