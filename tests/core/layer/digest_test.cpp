// SPDX-License-Identifier: Apache-2.0
#include "core/layer/digest.hpp"

#include <algorithm>
#include <map>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

using Map = std::map<BlockOrdinal, CodeBlock>;

Map random_map(test::Random& random) {
  Map map;
  while (map.size() < 60) {
    map.emplace(test::below(random, 3000), CodeBlock(test::random_codes(random)));
  }
  return map;
}

LayerDigest digest_of(const Map& map) {
  LayerDigest digest;
  for (const auto& [block, codes] : map) digest.update(block, codes);
  return digest;
}

CodeBlock with_one_voxel_changed(test::Random& random, const CodeBlock& block) {
  BlockCodes codes = block.unpack();
  const std::uint32_t place = test::below(random, kVoxelsPerBlock);
  const VoxelCode before = codes.at(place);
  while (codes.at(place) == before) codes.set(place, test::random_code(random));
  return CodeBlock(codes);
}

}  // namespace

TEST_CASE("a digest tells of what is in the map, not of how it got there") {
  test::Random random(1);
  const Map map = random_map(random);
  LayerDigest roundabout;
  for (int i = 0; i < 500; ++i) {
    const BlockOrdinal block = test::below(random, 3000);
    roundabout.update(block, CodeBlock(test::random_codes(random)));
    if (test::chance(random, 10)) roundabout.erase({block, block + test::below(random, 700)});
  }
  for (BlockOrdinal block = 0; block < 3000; ++block) {
    const auto found = map.find(block);
    roundabout.update(block, found == map.end() ? CodeBlock{} : found->second);
  }
  CHECK(roundabout.root() == digest_of(map).root());
  CHECK(roundabout.regions() == digest_of(map).regions());
  roundabout.erase({0, kOrdinalEnd});
  CHECK(roundabout.root() == LayerDigest{}.root());
}

TEST_CASE("one voxel that differs changes the root and is found by walking down") {
  test::Random random(2);
  const Map map = random_map(random);
  const LayerDigest digest = digest_of(map);
  for (const auto& [block, codes] : map) {
    LayerDigest changed = digest;
    changed.update(block, with_one_voxel_changed(random, codes));
    REQUIRE(changed.root() != digest.root());
    const auto regions = differing(digest.regions(), changed.regions());
    REQUIRE(regions == std::vector<std::uint64_t>{block >> 9});
    REQUIRE(differing(digest.blocks_of(regions[0]), changed.blocks_of(regions[0])) ==
            std::vector<std::uint64_t>{block});
    changed.update(block, codes);
    REQUIRE(changed.root() == digest.root());
  }
}

TEST_CASE("the same codes under another key make another digest") {
  test::Random random(3);
  const CodeBlock codes(test::random_codes(random));
  CHECK(digest_of({{5, codes}}).root() != digest_of({{6, codes}}).root());
}

TEST_CASE("blocks and regions that stand on one side only are found") {
  test::Random random(4);
  const CodeBlock codes(test::random_codes(random));
  const LayerDigest a = digest_of({{1, codes}, {600, codes}});
  const LayerDigest b = digest_of({{1, codes}, {2, codes}, {1100, codes}});
  CHECK(differing(a.regions(), b.regions()) == std::vector<std::uint64_t>{0, 1, 2});
  CHECK(differing(a.blocks_of(0), b.blocks_of(0)) == std::vector<std::uint64_t>{2});
  CHECK(a.blocks_of(2).empty());
}
