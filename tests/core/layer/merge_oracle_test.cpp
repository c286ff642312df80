// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <doctest/doctest.h>

#include "tests/core/layer/merge_world.hpp"

using namespace warren;
using test::MergedVoxels;
using test::MergeWorld;
using test::voxels_of;

namespace {

constexpr int kWorlds = 30;
constexpr int kSteps = 25;

MergeRule rule_of(std::uint64_t seed) {
  return seed % 2 == 0 ? MergeRule::kSafest : MergeRule::kNewest;
}

// Blocks where the two differ.
std::set<BlockKey> differing_blocks(const MergedVoxels& a, const MergedVoxels& b) {
  std::set<BlockKey> blocks;
  const auto collect = [&](const MergedVoxels& from, const MergedVoxels& to) {
    for (const auto& voxel : from) {
      const auto found = to.find(voxel.first);
      if (found == to.end() || found->second != voxel.second) blocks.insert(block_of(voxel.first));
    }
  };
  collect(a, b);
  collect(b, a);
  return blocks;
}

}  // namespace

TEST_CASE("after any events the merge-map is what its definition says, however small its cache") {
  std::size_t voxels = 0;
  for (std::uint64_t seed = 1; seed <= kWorlds; ++seed) {
    CAPTURE(seed);
    MergeWorld world(seed, rule_of(seed), 1 + seed % 7);
    for (int i = 0; i < kSteps; ++i) {
      world.step();
      // Some changes meet a cache that was not asked in between.
      if (i % 3 == 1) continue;
      const MergedVoxels merged = voxels_of(world.map());
      REQUIRE(merged == world.by_definition());
      REQUIRE(world.map().cached_blocks() <= 1 + seed % 7);
      voxels += merged.size();
    }
  }
  CHECK(voxels > 100000);
}

TEST_CASE("single voxels are the same as in a visit of all, known or not") {
  for (std::uint64_t seed = 101; seed <= 110; ++seed) {
    MergeWorld world(seed, rule_of(seed), 2);
    for (int i = 0; i < kSteps; ++i) world.step();
    const MergedVoxels merged = world.by_definition();
    test::Random random(seed);
    const auto axis = [&] { return static_cast<std::int32_t>(test::below(random, 48)) - 24; };
    for (int i = 0; i < 5000; ++i) {
      const VoxelKey key{axis(), axis(), axis()};
      const MergedVoxel voxel = world.map().voxel(key);
      const auto found = merged.find(key);
      REQUIRE((found == merged.end()) == (voxel.source == kNoSource));
      if (found == merged.end()) continue;
      REQUIRE(voxel.code.bits() == found->second.first);
      REQUIRE(world.map().source(voxel.source) == found->second.second);
    }
  }
}

TEST_CASE("the order of layers, blocks and events never shows") {
  for (std::uint64_t seed = 201; seed <= 220; ++seed) {
    CAPTURE(seed);
    MergeWorld world(seed, rule_of(seed), 8);
    for (int i = 0; i < kSteps; ++i) world.step();
    const MergedVoxels merged = voxels_of(world.map());
    for (int again = 0; again < 3; ++again) REQUIRE(world.merged_anew() == merged);
  }
}

TEST_CASE("whatever changed lies in a block that the merge-map names") {
  std::size_t changed = 0;
  for (std::uint64_t seed = 301; seed <= 320; ++seed) {
    CAPTURE(seed);
    MergeWorld world(seed, rule_of(seed), 8);
    MergedVoxels before;
    std::uint64_t cursor = 0;
    for (int i = 0; i < kSteps; ++i) {
      world.step();
      const MergedVoxels now = voxels_of(world.map());
      const auto named = world.map().blocks_changed_since(cursor);
      REQUIRE(named);
      const std::set<BlockKey> blocks(named->begin(), named->end());
      for (const BlockKey& block : differing_blocks(before, now)) {
        REQUIRE(blocks.contains(block));
        ++changed;
      }
      REQUIRE(world.map().blocks_changed_since(world.map().cursor())->empty());
      before = now;
      cursor = world.map().cursor();
    }
  }
  CHECK(changed > 1000);
}

TEST_CASE("a visit of a box is the part of all that lies in it") {
  const KeyBox box{{-9, -3, -20}, {2, 11, 5}};
  std::size_t voxels = 0;
  for (std::uint64_t seed = 401; seed <= 410; ++seed) {
    CAPTURE(seed);
    MergeWorld world(seed, MergeRule::kSafest, 4);
    for (int i = 0; i < kSteps; ++i) world.step();
    const MergedVoxels all = voxels_of(world.map());
    MergedVoxels inside;
    for (const auto& voxel : all) {
      if (box.contains(voxel.first)) inside.insert(voxel);
    }
    CHECK(inside.size() < all.size());
    CHECK(voxels_of(world.map(), box) == inside);
    voxels += inside.size();
  }
  CHECK(voxels > 100);
}
