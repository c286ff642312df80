// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/near_keys.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

namespace warren::replication {
namespace {

BlockOrdinal block_at(const Eigen::Vector3d& point, double resolution_m) {
  const auto key = *Lattice(resolution_m).key_of(point.x(), point.y(), point.z());
  return ordinal_of(block_of(key));
}

bool contains(const KeySet& keys, BlockOrdinal block) {
  return std::any_of(keys.intervals.begin(), keys.intervals.end(),
                     [&](const KeyInterval& interval) { return interval.contains(block); });
}

TEST_CASE("the keys near a point are all there, in few intervals in order") {
  test::Random random(3);
  const auto uniform = [&](double reach) {
    return (static_cast<double>(random() >> 11) * 0x1p-53 * 2.0 - 1.0) * reach;
  };
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d centre(uniform(300.0), uniform(300.0), uniform(20.0));
    const double radius_m = 5.0 + std::abs(uniform(100.0));
    const KeySet keys = near_keys(centre, radius_m, 0.1);
    REQUIRE(!keys.intervals.empty());
    REQUIRE(keys.intervals.size() <= KeySet::kIntervalsMax);
    for (std::size_t k = 1; k < keys.intervals.size(); ++k) {
      REQUIRE(keys.intervals[k - 1].end < keys.intervals[k].first);
    }
    for (int point = 0; point < 200; ++point) {
      const Eigen::Vector3d near =
          centre + Eigen::Vector3d(uniform(radius_m), uniform(radius_m), uniform(radius_m));
      REQUIRE(contains(keys, block_at(near, 0.1)));
    }
  }
}

TEST_CASE("most of what is far is left out") {
  const KeySet keys = near_keys({10.0, 10.0, 0.0}, 20.0, 0.1);
  CHECK_FALSE(contains(keys, block_at({300.0, 300.0, 0.0}, 0.1)));
  CHECK_FALSE(contains(keys, block_at({-300.0, 300.0, 0.0}, 0.1)));
}

TEST_CASE("a point beyond the key space has no keys near it") {
  CHECK(near_keys({1e7, 0.0, 0.0}, 10.0, 0.1).intervals.empty());
  CHECK(near_keys({NAN, 0.0, 0.0}, 10.0, 0.1).intervals.empty());
}

}  // namespace
}  // namespace warren::replication
