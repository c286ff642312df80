// SPDX-License-Identifier: Apache-2.0
#include "core/layer/holdings.hpp"

#include <algorithm>
#include <array>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

// The oracle: a revision per key of a small key space, whose last key stands for all above.
constexpr std::size_t kKeys = 200;
using Oracle = std::array<std::uint32_t, kKeys>;

std::size_t runs(const Oracle& oracle) {
  std::size_t count = 1;
  for (std::size_t i = 1; i < kKeys; ++i) count += oracle[i] != oracle[i - 1] ? 1 : 0;
  return count;
}

bool agree(const Holdings& holdings, const Oracle& oracle) {
  for (std::size_t i = 0; i < kKeys; ++i) {
    if (holdings.at(i).number != oracle[i]) return false;
  }
  return holdings.at(kOrdinalEnd - 1).number == oracle[kKeys - 1] &&
         holdings.intervals().size() == runs(oracle);
}

KeyInterval random_keys(test::Random& random) {
  const auto first = test::below(random, kKeys);
  const std::uint32_t longest = test::chance(random, 3) ? kKeys : 3;
  const auto end = first + 1 + test::below(random, longest);
  return {first, end >= kKeys ? kOrdinalEnd : BlockOrdinal{end}};
}

template <typename Change>
Oracle changed(Oracle oracle, const KeyInterval& keys, Change&& change) {
  for (std::size_t i = keys.first; i < std::min<BlockOrdinal>(keys.end, kKeys); ++i) {
    oracle[i] = static_cast<Oracle::value_type>(change(oracle[i]));
  }
  return oracle;
}

RaiseResult expected(const Oracle& oracle, const Oracle& raised, const Claim& claim) {
  if (raised != oracle) {
    return runs(raised) > Holdings::kIntervalsMax ? RaiseResult::kTooManyIntervals
                                                  : RaiseResult::kRaised;
  }
  bool gap = false;
  changed(oracle, claim.keys, [&](std::uint32_t held) {
    gap |= held < claim.from.number;
    return held;
  });
  return gap ? RaiseResult::kGap : RaiseResult::kDuplicate;
}

}  // namespace

TEST_CASE("holdings agree with a revision kept for every key") {
  test::Random random(1);
  std::array<std::size_t, 4> results{};
  for (int round = 0; round < 200; ++round) {
    Holdings holdings;
    Oracle oracle{};
    for (int step = 0; step < 300; ++step) {
      const KeyInterval keys = random_keys(random);
      if (test::chance(random, 3)) {
        const Oracle forgotten = changed(oracle, keys, [](std::uint32_t) { return 0; });
        REQUIRE(holdings.forget(keys) == (runs(forgotten) <= Holdings::kIntervalsMax));
        if (runs(forgotten) <= Holdings::kIntervalsMax) oracle = forgotten;
      }
      const std::uint32_t from = test::below(random, 20);
      const Claim claim{keys, {from}, {from + 1 + test::below(random, 10)}};
      const Oracle raised = changed(oracle, keys, [&](std::uint32_t held) {
        return claim.from.number <= held && held < claim.to.number ? claim.to.number : held;
      });
      const RaiseResult result = expected(oracle, raised, claim);
      REQUIRE(holdings.judge(claim) == result);
      REQUIRE(holdings.raise(claim) == result);
      if (result == RaiseResult::kRaised) oracle = raised;
      ++results[static_cast<std::size_t>(result)];
      REQUIRE(agree(holdings, oracle));
    }
  }
  for (const std::size_t count : results) CHECK(count > 0);
}

TEST_CASE("holdings answer for intervals") {
  Holdings holdings;
  CHECK(holdings.raise({{10, 20}, {0}, {5}}) == RaiseResult::kRaised);
  CHECK(holdings.raise({{15, 30}, {0}, {7}}) == RaiseResult::kRaised);
  CHECK(holdings.at(9) == Revision{0});
  CHECK(holdings.at(14) == Revision{5});
  CHECK(holdings.at(15) == Revision{7});
  CHECK(holdings.at(30) == Revision{0});
  CHECK(holdings.lowest({12, 18}) == Revision{5});
  CHECK(holdings.lowest({12, 31}) == Revision{0});
  CHECK(holdings.highest({0, 15}) == Revision{5});
  CHECK(holdings.highest({0, 16}) == Revision{7});
  CHECK(holdings.interval_around(16) == KeyInterval{15, 30});
  CHECK(holdings.interval_around(kOrdinalEnd - 1) == KeyInterval{30, kOrdinalEnd});
  CHECK(*holdings.first_below({1}) == 0);
  CHECK(holdings.raise({{0, 10}, {0}, {7}}) == RaiseResult::kRaised);
  CHECK(*holdings.first_below({7}) == 10);
  CHECK_FALSE(Holdings(Revision{7}).first_below({7}));
}

TEST_CASE("a sweep in key order goes through however many intervals are held") {
  Holdings holdings;
  for (BlockOrdinal key = 1; holdings.intervals().size() < Holdings::kIntervalsMax - 1; key += 2) {
    REQUIRE(holdings.raise({{key, key + 1}, {0}, {static_cast<std::uint32_t>(key)}}) ==
            RaiseResult::kRaised);
  }
  REQUIRE(holdings.raise({{1000, kOrdinalEnd}, {0}, {1}}) == RaiseResult::kRaised);
  CHECK(holdings.raise({{500, 501}, {0}, {9}}) == RaiseResult::kTooManyIntervals);
  for (BlockOrdinal key = 0; key < 1000; ++key) {
    REQUIRE(holdings.raise({{key, key + 1}, {0}, {999}}) == RaiseResult::kRaised);
  }
  CHECK(holdings.intervals().size() == 2);
}

TEST_CASE("intervals from outside are checked") {
  using Interval = Holdings::Interval;
  const auto accepted = [](std::vector<Interval> intervals) {
    return Holdings::from_intervals(intervals).has_value();
  };
  CHECK(accepted({{0, {3}}}));
  CHECK(accepted({{0, {3}}, {9, {4}}}));
  CHECK_FALSE(accepted({}));
  CHECK_FALSE(accepted({{1, {3}}}));
  CHECK_FALSE(accepted({{0, {3}}, {9, {3}}}));
  CHECK_FALSE(accepted({{0, {3}}, {9, {4}}, {9, {5}}}));
  CHECK_FALSE(accepted({{0, {3}}, {kOrdinalEnd, {4}}}));
  std::vector<Interval> many;
  for (std::uint32_t i = 0; i <= Holdings::kIntervalsMax; ++i) many.push_back({i, {i}});
  CHECK_FALSE(accepted(many));
  many.pop_back();
  CHECK(accepted(many));
}
