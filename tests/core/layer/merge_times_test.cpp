// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_times.hpp"

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

TEST_CASE("times of many revisions stay few, and do not depend on the order of notes") {
  std::vector<std::uint32_t> revisions;
  for (std::uint32_t i = 1; i <= 3000; ++i) revisions.push_back(i);
  const auto noted = [&] {
    MergeTimes times;
    for (const std::uint32_t i : revisions) times.note({i}, std::int64_t{10} * i);
    return times;
  };
  const MergeTimes in_order = noted();
  test::Random random(3);
  std::shuffle(revisions.begin(), revisions.end(), random);
  const MergeTimes shuffled = noted();
  CHECK(in_order.size() <= MergeTimes::kTimesMax);
  CHECK(in_order.size() > MergeTimes::kTimesMax / 4);
  for (std::uint32_t i = 1; i <= 3001; ++i) {
    REQUIRE(in_order.time_ns({i}) == shuffled.time_ns({i}));
    REQUIRE(in_order.time_ns({i}) >= std::int64_t{10} * std::min(i, 3000U));
    REQUIRE(in_order.time_ns({i}) < std::int64_t{10} * i + 320);
  }
}
