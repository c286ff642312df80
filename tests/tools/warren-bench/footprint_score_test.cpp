// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/footprint_score.hpp"

#include <doctest/doctest.h>

using namespace warren;

namespace {

// One point in the middle of every voxel column of a square floor.
std::vector<JudgedPoint> floor_of(float cost, int per_side = 20) {
  std::vector<JudgedPoint> points;
  for (int x = 0; x < per_side; ++x) {
    for (int y = 0; y < per_side; ++y) {
      points.push_back(
          {{0.1F + 0.2F * static_cast<float>(x), 0.1F + 0.2F * static_cast<float>(y), 0.05F},
           cost,
           Evidence::kPlane});
    }
  }
  return points;
}

constexpr Point3f kMiddle{2.0F, 2.0F, 0.05F};

std::optional<double> score(const std::vector<JudgedPoint>& points) {
  VoxelCosts costs;
  costs.assign(points);
  return costs.score(kMiddle, {});
}

}  // namespace

TEST_CASE("an even floor scores its own cost") {
  CHECK(*score(floor_of(0.07F)) == doctest::Approx(0.07));
  CHECK(*score(floor_of(0.0F)) == 0.0);
}

TEST_CASE("one bad voxel scores half its cost: the planner's rule for the maximum") {
  auto points = floor_of(0.0F);
  points.push_back({{2.1F, 2.1F, 0.25F}, 0.19F, Evidence::kPlane});
  CHECK(*score(points) < 0.10);
  points.back().cost = 0.21F;
  CHECK(*score(points) > 0.10);
}

TEST_CASE("a voxel costs the mean of its points") {
  auto points = floor_of(0.0F);
  points.push_back({{2.1F, 2.1F, 0.06F}, 1.0F, Evidence::kPlane});
  points.push_back({{2.1F, 2.1F, 0.07F}, 1.0F, Evidence::kRing});  // has no cost
  CHECK(*score(points) == doctest::Approx(0.25));
}

TEST_CASE("only what the body sweeps counts") {
  for (const Point3f& outside :
       {Point3f{2.7F, 2.0F, 0.1F}, Point3f{2.0F, 2.0F, 1.2F}, Point3f{2.0F, 2.0F, -0.6F}}) {
    auto points = floor_of(0.0F);
    points.push_back({outside, 1.0F, Evidence::kPlane});
    CHECK(*score(points) == 0.0);
  }
}

TEST_CASE("with too little of the footprint known there is no data") {
  auto points = floor_of(0.0F);
  for (JudgedPoint& point : points) {
    if (point.position_layer.x > 1.6F) point.evidence = Evidence::kTooWide;
  }
  CHECK_FALSE(score(points));
  CHECK_FALSE(score({}));
}
