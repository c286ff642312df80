// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/cloud_reduction.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/core/terrain/clouds.hpp"

using namespace warren;

namespace {

bool same(const ReducedCloud& a, const ReducedCloud& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.weights == b.weights;
}

}  // namespace

TEST_CASE("every point is in the centroid of its cell") {
  CHECK(rc::check("centroids", [] {
    const auto points = test::arbitrary_cloud(300);
    std::map<std::array<float, 3>, std::array<double, 4>> cells;
    for (const Point3f& p : points) {
      auto& sum =
          cells[{std::floor(p.x * 20.0F), std::floor(p.y * 20.0F), std::floor(p.z * 20.0F)}];
      sum = {sum[0] + p.x, sum[1] + p.y, sum[2] + p.z, sum[3] + 1.0};
    }
    std::vector<std::array<float, 4>> wanted;
    for (const auto& [cell, s] : cells) {
      wanted.push_back({static_cast<float>(s[0] / s[3]), static_cast<float>(s[1] / s[3]),
                        static_cast<float>(s[2] / s[3]), static_cast<float>(s[3])});
    }
    CloudReducer reducer(0.05F);
    const ReducedCloud& reduced = reducer.reduce(points);
    std::vector<std::array<float, 4>> got;
    for (std::size_t i = 0; i < reduced.size(); ++i) {
      got.push_back(
          {reduced.x[i], reduced.y[i], reduced.z[i], static_cast<float>(reduced.weights[i])});
    }
    RC_ASSERT(got.size() == wanted.size());
    // Not by sorted order: rounding may turn two cells whose centroids share a coordinate.
    for (const auto& cell : wanted) {
      RC_ASSERT(std::any_of(got.begin(), got.end(), [&](const auto& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const float tolerance = 1e-6F + 2e-7F * std::abs(cell[axis]);
          if (std::abs(other[axis] - cell[axis]) > tolerance) return false;
        }
        return other[3] == cell[3];
      }));
    }
  }));
}

TEST_CASE("the order of points does not change a bit of the reduced cloud") {
  CHECK(rc::check("shuffled", [](std::uint32_t seed) {
    auto points = test::arbitrary_cloud(300);
    CloudReducer first(0.05F);
    CloudReducer second(0.05F);
    const ReducedCloud& a = first.reduce(points);
    std::shuffle(points.begin(), points.end(), std::mt19937(seed));
    RC_ASSERT(same(a, second.reduce(points)));
    RC_ASSERT(same(a, second.reduce(points)));
  }));
}

TEST_CASE("tiles hold all points, each in its own tile's range, in order") {
  CloudReducer reducer(0.05F);
  const ReducedCloud& cloud = reducer.reduce(test::ramp(0.3F));
  std::uint32_t next = 0;
  for (const Tile& tile : cloud.tiles.tiles()) {
    CHECK(tile.points.first == next);
    CHECK(tile.points.end > next);
    next = tile.points.end;
  }
  CHECK(next == cloud.size());
  CHECK(std::accumulate(cloud.weights.begin(), cloud.weights.end(), 0U) == 41 * 41);
}

TEST_CASE("points outside of the sphere are left out and counted") {
  CloudReducer reducer(0.05F);
  const std::vector<Point3f> points = {
      {1.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 2.001F}, {1e30F, 0.0F, 0.0F}};
  const ReducedCloud& reduced = reducer.reduce(points, {{1.0F, 0.0F, 0.0F}, 2.0F});
  CHECK(reduced.size() == 2);  // the border belongs to it
  CHECK(reducer.report().too_far == 1);
  CHECK(reducer.report().outside == 1);
  CHECK(reducer.reduce(points).size() == 3);
  CHECK(reducer.report().too_far == 0);
}
