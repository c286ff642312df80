// SPDX-License-Identifier: Apache-2.0
#include "core/layer/layer_difference.hpp"

#include <vector>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

constexpr BlockOrdinal kBlocks = 1500;

Replica layer_of(const std::vector<BlockCodes>& blocks) {
  Replica layer({1, 1, 1}, kDefaultResolution);
  std::vector<CodedBlock> coded;
  for (BlockOrdinal block = 0; block < blocks.size(); ++block) {
    coded.push_back({block, CodeBlock(blocks[block])});
  }
  layer.publish(coded);
  return layer;
}

}  // namespace

TEST_CASE("layers differ voxel by voxel, each difference by its kind") {
  test::Random random(1);
  std::vector<BlockCodes> a(kBlocks);
  for (BlockCodes& codes : a) codes = test::random_codes(random, 10);
  std::vector<BlockCodes> b = a;
  LayerDifference expected;
  for (int count = 0; count < 200; ++count) {
    const std::uint32_t block = test::below(random, kBlocks);
    const std::uint32_t place = test::below(random, kVoxelsPerBlock);
    b[block].set(place, test::random_code(random));
  }
  for (BlockOrdinal block = 0; block < kBlocks; ++block) {
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      const VoxelCode here = a[block].at(place);
      const VoxelCode there = b[block].at(place);
      const bool known_here = here.state() != VoxelState::kUnknown;
      const bool known_there = there.state() != VoxelState::kUnknown;
      expected.only_in_a += known_here && !known_there ? 1 : 0;
      expected.only_in_b += !known_here && known_there ? 1 : 0;
      if (!known_here || !known_there) continue;
      expected.occupancy += here.state() != there.state() ? 1 : 0;
      if (here.state() != there.state()) continue;
      expected.cost += here.cost() != there.cost() ? 1 : 0;
      expected.stair += here.stair() != there.stair() ? 1 : 0;
    }
  }
  const Replica layer_a = layer_of(a);
  Replica layer_b = layer_of(b);
  CHECK(expected.only_in_b > 50);
  CHECK(expected.cost > 0);
  CHECK(difference_of(layer_a, layer_b) == expected);
  layer_b.rest({1}, kBlocks);
  CHECK(difference_of(layer_a, layer_b) == expected);
  CHECK(difference_of(layer_a, layer_b).any());
  CHECK_FALSE(difference_of(layer_b, layer_of(b)).any());
}
