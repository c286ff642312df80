// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <doctest/doctest.h>

#include "core/voxel/self_map.hpp"

using namespace warren;

namespace {

SelfMap corridor() {
  SelfMap map(SelfMapConfig{});
  std::vector<Point3f> wall;
  for (int y = -5; y <= 5; ++y)
    wall.push_back({2.05F, 0.05F + 0.1F * static_cast<float>(y), 0.05F});
  map.integrate({{0.05F, 0.05F, 0.05F}, wall, std::nullopt, {}});
  return map;
}

}  // namespace

TEST_CASE("a ray stops at the first occupied voxel") {
  const SelfMap map = corridor();
  const auto hit = map.cast_ray({{0.05F, 0.05F, 0.05F}, {1.0F, 0.0F, 0.0F}, 10.0, true});
  REQUIRE(hit);
  CHECK(hit->state == VoxelState::kOccupied);
  CHECK(hit->key == VoxelKey{20, 0, 0});
  CHECK(hit->range_m == doctest::Approx(1.95).epsilon(1e-6));
}

TEST_CASE("a ray into the unknown stops there, or goes on if told so") {
  const SelfMap map = corridor();
  const RayQuery up{{0.05F, 0.05F, 0.05F}, {0.0F, 0.0F, 2.0F}, 10.0, true};
  const auto hit = map.cast_ray(up);
  REQUIRE(hit);
  CHECK(hit->state == VoxelState::kUnknown);
  CHECK(hit->key == VoxelKey{0, 0, 1});
  RayQuery through = up;
  through.unknown_stops = false;
  CHECK_FALSE(map.cast_ray(through));
}

TEST_CASE("a ray ends at its range") {
  const SelfMap map = corridor();
  CHECK_FALSE(map.cast_ray({{0.05F, 0.05F, 0.05F}, {1.0F, 0.0F, 0.0F}, 1.9, true}));
}

TEST_CASE("a ray of no direction, from nowhere, or without end finds nothing and returns") {
  const SelfMap map = corridor();
  CHECK_FALSE(map.cast_ray({{0.05F, 0.05F, 0.05F}, {0.0F, 0.0F, 0.0F}, 10.0, true}));
  CHECK_FALSE(map.cast_ray({{1e9F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, 10.0, true}));
  CHECK_FALSE(map.cast_ray({{NAN, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, 10.0, true}));
  CHECK_FALSE(map.cast_ray({{0.05F, 0.05F, 0.05F}, {-1.0F, 0.3F, 0.0F}, INFINITY, false}));
}
