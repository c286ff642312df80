// SPDX-License-Identifier: Apache-2.0
#include "core/layer/code_block.hpp"

#include <set>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

TEST_CASE("a voxel's code fits in seven bits and no two differ only in what does not count") {
  std::set<std::uint8_t> bits = {VoxelCode{}.bits(), VoxelCode::free().bits()};
  for (int cost = 0; cost < 16; ++cost) {
    for (const bool stair : {false, true}) {
      const auto code = VoxelCode::occupied(static_cast<CostCode>(cost), stair);
      CHECK(code.state() == VoxelState::kOccupied);
      CHECK(code.cost() == cost);
      CHECK(code.stair() == stair);
      bits.insert(code.bits());
    }
  }
  CHECK(bits.size() == 34);
  CHECK(*bits.rbegin() < 1 << VoxelCode::kBits);
  CHECK(VoxelCode{}.state() == VoxelState::kUnknown);
  CHECK(VoxelCode::free().state() == VoxelState::kFree);
}

TEST_CASE("a packed block gives back the codes it was made of") {
  test::Random random(1);
  for (int round = 0; round < 200; ++round) {
    const BlockCodes codes = test::random_codes(random, test::below(random, 101));
    const CodeBlock block(codes);
    REQUIRE(block.unpack() == codes);
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      REQUIRE(block.at(place) == codes.at(place));
    }
    BlockCodes visited;
    block.for_each_known([&](std::uint32_t place, VoxelCode code) { visited.set(place, code); });
    REQUIRE(visited == codes);
  }
}

TEST_CASE("blocks are equal exactly when all their codes are") {
  test::Random random(2);
  for (int round = 0; round < 200; ++round) {
    BlockCodes codes = test::random_codes(random);
    const CodeBlock block(codes);
    CHECK(block == CodeBlock(block.unpack()));
    const std::uint32_t place = test::below(random, kVoxelsPerBlock);
    const VoxelCode before = codes.at(place);
    const VoxelCode after = test::random_code(random);
    codes.set(place, after);
    CHECK((block == CodeBlock(codes)) == (before == after));
  }
  CHECK(CodeBlock{}.empty());
  CHECK(CodeBlock(BlockCodes{}) == CodeBlock{});
}

TEST_CASE("overlay takes what is known and leaves the rest") {
  test::Random random(3);
  for (int round = 0; round < 100; ++round) {
    const BlockCodes below = test::random_codes(random, 50);
    const BlockCodes above = test::random_codes(random, 50);
    BlockCodes both = below;
    both.overlay(above);
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      REQUIRE(both.at(place) == (contains(above.known, place) ? above : below).at(place));
    }
    REQUIRE(CodeBlock(both).unpack() == both);
  }
}

TEST_CASE("a block half known, with a wall in it, takes less than a byte per known voxel") {
  BlockCodes codes;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelKey voxel = place_of_morton9(place);
    if (voxel.z == 3) codes.set(place, VoxelCode::occupied(4, voxel.x == 0));
    if (voxel.z > 3) codes.set(place, VoxelCode::free());
  }
  const CodeBlock block(codes);
  CHECK(sizeof(block) + block.heap_bytes() < 320);
}
