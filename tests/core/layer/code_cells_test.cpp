// SPDX-License-Identifier: Apache-2.0
#include "core/layer/code_cells.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "tests/core/layer/mine_layer.hpp"

using namespace warren;

namespace {

constexpr LayerId kLayer{7, 1, 0x1234};
constexpr double kResolution_m = 0.1;

bool equal(const CodeNode& a, const CodeNode& b) {
  return a.low == b.low && a.level == b.level && a.code == b.code &&
         a.has_children == b.has_children;
}

// Voxel by voxel.
CodeNode brute_force(const Replica& layer, const VoxelKey& low, int level) {
  CodeMix mix;
  for (std::int32_t x = low.x; x < low.x + (1 << level); ++x) {
    for (std::int32_t y = low.y; y < low.y + (1 << level); ++y) {
      for (std::int32_t z = low.z; z < low.z + (1 << level); ++z) {
        const std::uint64_t morton = morton_of({x, y, z});
        mix |= CodeMix(layer.codes(morton >> 9).at(static_cast<std::uint32_t>(morton & 511)));
      }
    }
  }
  return CodeNode::of(low, level, mix);
}

}  // namespace

TEST_CASE("cells tile the box, on the octree's borders") {
  const CellGrid grid({{-3, 0, 5}, {8, 7, 5}}, 3);
  CHECK(grid.size() == 3);
  CHECK(grid.low(0) == VoxelKey{-8, 0, 0});
  CHECK(grid.low(2) == VoxelKey{8, 0, 0});
  CHECK(grid.voxels().high == VoxelKey{15, 7, 7});
  test::Random random(1);
  for (int round = 0; round < 1000; ++round) {
    const auto key = [&] {
      return static_cast<std::int32_t>(test::below(random, 65536)) + kKeyMin;
    };
    const VoxelKey a{key(), key(), key()};
    const VoxelKey b{key(), key(), key()};
    const int level = static_cast<int>(test::below(random, CodeOctree::kRootLevel + 1));
    const KeyBox box{{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                     {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
    const CellGrid cells(box, level);
    for (const VoxelKey& voxel : {box.low, box.high, a}) {
      const VoxelKey low = cells.low(cells.index_of(voxel));
      const std::int32_t edge = 1 << level;
      CHECK(KeyBox{low, {low.x + edge - 1, low.y + edge - 1, low.z + edge - 1}}.contains(voxel));
      CHECK(morton_of(low) % (std::uint64_t{1} << 3 * level) == 0);
    }
    CHECK(cells.index_of(box.low) == 0);
    CHECK(cells.index_of(box.high) == cells.size() - 1);
  }
  CHECK(CellGrid(KeyBox{}, CodeOctree::kRootLevel).size() == 1);
}

TEST_CASE("a layer and the merge-map of it tell the same cells, and both what brute force tells") {
  Replica layer = test::mine_layer(kLayer, 12);
  MergeMap map({kResolution_m});
  REQUIRE(map.add_layer(kLayer, layer, kResolution_m, Eigen::Isometry3d::Identity()) ==
          MergeResult::kDone);
  std::size_t mixed = 0;
  for (const int level : {0, 1, 2, 3, 4}) {
    const std::int32_t reach = 4 << level;
    const CellGrid grid({{40 - reach, -reach, -8}, {40 + reach, reach, reach}}, level);
    const auto of_layer = cells_of(layer, grid);
    const auto of_map = cells_of(map, grid);
    REQUIRE(of_layer.size() == grid.size());
    REQUIRE(of_map.size() == grid.size());
    for (std::uint64_t i = 0; i < grid.size(); ++i) {
      const CodeNode expected = brute_force(layer, grid.low(i), level);
      CHECK(equal(of_layer[i], expected));
      CHECK(equal(of_map[i], expected));
      mixed += expected.has_children ? 1 : 0;
    }
  }
  CHECK(mixed > 10);
  const CellGrid whole(KeyBox{}, CodeOctree::kRootLevel);
  CHECK(equal(cells_of(layer, whole).front(), cells_of(map, whole).front()));
}
