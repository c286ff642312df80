// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <doctest/doctest.h>

#include "tests/core/layer/merge_world.hpp"

using namespace warren;
using test::MergeWorld;

namespace {

constexpr int kSteps = 25;
constexpr BlockBox kAll{{-4096, -4096, -4096}, {4095, 4095, 4095}};

std::vector<BlockKey> changed_in(MergeMap& map, std::uint64_t cursor, const BlockBox& box,
                                 BlockOrdinal first) {
  std::vector<BlockKey> blocks;
  map.for_each_changed_block(cursor, box, first, [&](const BlockKey& block) {
    blocks.push_back(block);
    return true;
  });
  return blocks;
}

}  // namespace

TEST_CASE("changed blocks of a box, from a key on, are those of all that lie there, in order") {
  std::size_t found = 0;
  for (std::uint64_t seed = 501; seed <= 510; ++seed) {
    CAPTURE(seed);
    MergeWorld world(seed, MergeRule::kSafest, 8);
    for (int i = 0; i < kSteps; ++i) world.step();
    const std::uint64_t cursor = world.map().cursor();
    for (int i = 0; i < 5; ++i) world.step();
    for (const std::uint64_t since : {std::uint64_t{0}, cursor}) {
      const auto all = world.map().blocks_changed_since(since);
      REQUIRE(all.has_value());
      REQUIRE(std::is_sorted(all->begin(), all->end(), [](const auto& a, const auto& b) {
        return ordinal_of(a) < ordinal_of(b);
      }));
      CHECK(changed_in(world.map(), since, kAll, 0) == *all);
      if (all->empty()) continue;
      const BlockOrdinal first = ordinal_of((*all)[all->size() / 2]);
      const BlockBox box{{-2, -9, -1}, {9, 1, 1}};
      std::vector<BlockKey> expected;
      std::copy_if(all->begin(), all->end(), std::back_inserter(expected), [&](const auto& block) {
        return ordinal_of(block) >= first && box.index_of(block).has_value();
      });
      CHECK(changed_in(world.map(), since, box, first) == expected);
      found += expected.size();
    }
  }
  CHECK(found > 50);
}

TEST_CASE("a visit of changed blocks ends when the visitor has had enough") {
  MergeWorld world(601, MergeRule::kSafest, 8);
  for (int i = 0; i < kSteps; ++i) world.step();
  int visited = 0;
  world.map().for_each_changed_block(0, kAll, 0, [&](const BlockKey&) { return ++visited < 3; });
  CHECK(visited == 3);
}

TEST_CASE("the codes of a block are those of its voxels, known to any layer or not") {
  MergeWorld world(701, MergeRule::kSafest, 2);
  for (int i = 0; i < kSteps; ++i) world.step();
  std::size_t known = 0;
  const auto blocks = world.map().blocks_changed_since(0);
  REQUIRE(blocks.has_value());
  for (const BlockKey& block : *blocks) {
    const auto codes = world.map().codes(block);
    const VoxelKey first = first_voxel_of(block);
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      const VoxelKey at = place_of_morton9(place);
      REQUIRE(codes[place] ==
              world.map().voxel(VoxelKey{first.x + at.x, first.y + at.y, first.z + at.z}).code);
      known += codes[place] == VoxelCode{} ? 0 : 1;
    }
  }
  CHECK(known > 100);
  const auto beyond = world.map().codes({4000, 4000, 4000});
  CHECK(std::count(beyond.begin(), beyond.end(), VoxelCode{}) == 512);
}

TEST_CASE("own blocks that are told again as they were are no change") {
  MergeMap map({0.1});
  REQUIRE(map.open_self_layer(0, Eigen::Isometry3d::Identity()) == MergeResult::kDone);
  test::Random random(1);
  const std::vector<CodedBlock> blocks{
      {ordinal_of({0, 0, 0}), CodeBlock(test::random_codes(random))},
      {ordinal_of({1, 0, 0}), CodeBlock(test::random_codes(random))}};
  map.update_self(0, blocks);
  const std::uint64_t cursor = map.cursor();
  map.update_self(0, blocks);
  CHECK(map.blocks_changed_since(cursor)->empty());
  const std::vector<CodedBlock> one{{ordinal_of({1, 0, 0}), CodeBlock()}};
  map.update_self(0, one);
  CHECK(map.blocks_changed_since(cursor) == std::vector<BlockKey>{{1, 0, 0}});
  map.update_self(0, one);
  CHECK(map.blocks_changed_since(map.cursor() - 1)->empty());
}
