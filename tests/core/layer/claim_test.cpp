// SPDX-License-Identifier: Apache-2.0
#include "core/layer/claim.hpp"

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

TEST_CASE("every block has its place in one order, and regions are contiguous in it") {
  test::Random random(1);
  const auto axis = [&] { return static_cast<std::int32_t>(test::below(random, 8192)) - 4096; };
  for (int round = 0; round < 1000; ++round) {
    const BlockKey key{axis(), axis(), axis()};
    const BlockOrdinal ordinal = ordinal_of(key);
    REQUIRE(ordinal < kOrdinalEnd);
    REQUIRE(block_key_of(ordinal) == key);
    const BlockKey first{key.x & ~7, key.y & ~7, key.z & ~7};
    REQUIRE(ordinal_of(first) == (ordinal & ~BlockOrdinal{511}));
  }
  CHECK(ordinal_of({-4096, -4096, -4096}) == 0);
  CHECK(ordinal_of({4095, 4095, 4095}) == kOrdinalEnd - 1);
}

TEST_CASE("a claim of nothing, of no time or beyond the key space is not valid") {
  CHECK(Claim{{0, kOrdinalEnd}, {0}, {1}}.valid());
  CHECK_FALSE(Claim{{5, 5}, {0}, {1}}.valid());
  CHECK_FALSE(Claim{{5, 9}, {3}, {3}}.valid());
  CHECK_FALSE(Claim{{5, kOrdinalEnd + 1}, {3}, {4}}.valid());
}
