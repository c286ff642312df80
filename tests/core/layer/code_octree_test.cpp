// SPDX-License-Identifier: Apache-2.0
#include "core/layer/code_octree.hpp"

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

constexpr LayerId kLayer{7, 1, 0x1234};

VoxelCode code_at(const Replica& layer, std::uint64_t morton) {
  const LayerBlock* const found = layer.find(morton >> 9);
  return found != nullptr ? found->codes.at(static_cast<std::uint32_t>(morton & 511)) : VoxelCode{};
}

// Blocks of noise, uniform ones and large uniform cubes, within 2^6 voxels of the corner.
Replica random_layer(std::uint64_t seed) {
  test::Random random(seed);
  std::vector<CodedBlock> blocks;
  for (BlockOrdinal block = 0; block < 512; ++block) {
    BlockCodes codes;
    const std::uint32_t kind = block < 128 ? 0 : test::below(random, 4);
    if (kind == 1) codes = test::random_codes(random, 3);
    const VoxelCode fill = block < 64 ? VoxelCode::free() : VoxelCode::occupied(3, true);
    const std::uint32_t filled = kind == 0 ? kVoxelsPerBlock : kind == 2 ? 64 : 0;
    for (std::uint32_t place = 0; place < filled; ++place) codes.set(place, fill);
    if (any(codes.known)) blocks.push_back({block, CodeBlock(codes)});
  }
  Replica layer(kLayer, kDefaultResolution);
  layer.publish(blocks);
  return layer;
}

struct Expected {
  bool uniform = true;
  bool unknown = false;
  bool occupied = false;
  bool stair = false;
  bool without_data = false;
  CostCode highest = 0;
};

Expected expected_of(const Replica& layer, std::uint64_t first, int level) {
  Expected expected;
  const VoxelCode one = code_at(layer, first);
  for (std::uint64_t voxel = first; voxel < first + (std::uint64_t{1} << 3 * level); ++voxel) {
    const VoxelCode code = code_at(layer, voxel);
    expected.uniform &= code == one;
    expected.unknown |= code.state() == VoxelState::kUnknown;
    if (code.state() != VoxelState::kOccupied) continue;
    expected.occupied = true;
    expected.stair |= code.stair();
    expected.without_data |= code.cost() == kNoCostData;
    expected.highest = std::max(expected.highest, code.cost());
  }
  return expected;
}

VoxelCode worst_of(const Expected& expected) {
  if (!expected.occupied) return expected.unknown ? VoxelCode{} : VoxelCode::free();
  const bool no_data = expected.without_data && expected.highest <= 4;  // codes up to 0.20
  return VoxelCode::occupied(no_data ? kNoCostData : expected.highest, expected.stair);
}

}  // namespace

TEST_CASE("a node has the code of its voxels, or the worst of them and children") {
  const Replica layer = random_layer(1);
  test::Random random(2);
  const CodeOctree tree(layer);
  for (int round = 0; round < 3000; ++round) {
    const int level = round % 7;
    const std::uint64_t first = random() % (1 << 18) >> 3 * level << 3 * level;
    const CodeNode node = tree.node(key_of_morton(first), level);
    const Expected expected = expected_of(layer, first, level);
    CHECK(morton_of(node.low) == first);
    CHECK(node.has_children != expected.uniform);
    CHECK(node.code == worst_of(expected));
  }
  CHECK(tree.node({0, 0, 0}, 6).code == VoxelCode{});
  CHECK_FALSE(tree.node({0, 0, 0}, 15).has_children);
  CHECK(tree.node({kKeyMin, kKeyMin, kKeyMin}, CodeOctree::kRootLevel).has_children);
}

TEST_CASE("the leaves tile what is known and could not be fewer") {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Replica layer = random_layer(seed);
    const CodeOctree tree(layer);
    for (const int min_level : {0, 1, 2, 3, 5}) {
      std::vector<CodeNode> leaves;
      tree.for_each_leaf(min_level, [&](const CodeNode& leaf) { leaves.push_back(leaf); });
      std::uint64_t next = 0;
      for (const CodeNode& leaf : leaves) {
        const std::uint64_t first = morton_of(leaf.low);
        REQUIRE(first >= next);
        for (; next < first; ++next) REQUIRE(code_at(layer, next) == VoxelCode{});
        const CodeNode node = tree.node(leaf.low, leaf.level);
        REQUIRE(node.code == leaf.code);
        REQUIRE(node.has_children == leaf.has_children);
        REQUIRE((leaf.level == min_level || !leaf.has_children));
        REQUIRE(tree.node(leaf.low, leaf.level + 1).has_children);
        next = first + (std::uint64_t{1} << 3 * leaf.level);
      }
      for (; next < 1 << 18; ++next) REQUIRE(code_at(layer, next) == VoxelCode{});
    }
  }
}

TEST_CASE("only equal codes are pruned, costs are never averaged, and unknown stays unknown") {
  BlockCodes codes;
  for (std::uint32_t place = 0; place < 64; ++place) {
    codes.set(place, VoxelCode::occupied(place == 9 ? CostCode{2} : CostCode{1}, false));
  }
  for (std::uint32_t place = 64; place < 71; ++place) codes.set(place, VoxelCode::free());
  Replica layer(kLayer, kDefaultResolution);
  layer.publish({{CodedBlock{0, CodeBlock(codes)}}});
  const CodeOctree tree(layer);
  const VoxelKey corner{kKeyMin, kKeyMin, kKeyMin};
  CHECK(tree.node(corner, 1).code == VoxelCode::occupied(1, false));
  CHECK_FALSE(tree.node(corner, 1).has_children);
  CHECK(tree.node(corner, 2).code == VoxelCode::occupied(2, false));
  CHECK(tree.node(corner, 2).has_children);
  const VoxelKey beside = key_of_morton(64);
  CHECK(tree.node(beside, 1).code == VoxelCode{});
  CHECK(tree.node(beside, 1).has_children);
}

TEST_CASE("what has no cost data never passes for easy ground") {
  const auto worst = [](CostCode cost) {
    CodeMix mix(VoxelCode::occupied(kNoCostData, false));
    mix |= CodeMix(VoxelCode::occupied(cost, false));
    return mix.worst().cost();
  };
  CHECK(worst(1) == kNoCostData);
  CHECK(worst(4) == kNoCostData);
  CHECK(worst(5) == 5);
  CHECK(worst(15) == 15);
}

TEST_CASE("a layer of which nothing is known has no leaves") {
  const Replica layer(kLayer, kDefaultResolution);
  CodeOctree(layer).for_each_leaf(0, [](const CodeNode&) { FAIL("a leaf"); });
  CHECK(CodeOctree(layer).node({0, 0, 0}, 16).code == VoxelCode{});
}
