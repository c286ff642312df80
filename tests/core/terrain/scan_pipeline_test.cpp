// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/scan_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "tests/core/terrain/clouds.hpp"

using namespace warren;

namespace {

constexpr Point3f kDown{0.0F, 0.0F, -1.0F};
constexpr float kPi = 3.14159265F;

// A ramp of 2 m by 2 m ahead of the sensor, dense as a lidar's floor near by.
std::vector<Point3f> ramp_ahead(float slope_deg, float spacing_m = 0.02F) {
  auto points = test::ramp(slope_deg * kPi / 180.0F, static_cast<int>(2.0F / spacing_m), spacing_m);
  for (Point3f& p : points) p = {p.x + 1.0F, p.y - 1.0F, p.z - 0.55F};
  return points;
}

struct Costs {
  std::size_t voxels = 0;
  float least = 1.0F;
  float greatest = 0.0F;
};

// Of the costed voxels that lie in a box.
Costs costs_in(const SelfMap& map, const KeyBox& box) {
  Costs costs;
  map.for_each_known_voxel(box, [&](const VoxelKey& key, VoxelState, float) {
    const auto cost = map.cost(key);
    if (!cost) return;
    ++costs.voxels;
    costs.least = std::min(costs.least, *cost);
    costs.greatest = std::max(costs.greatest, *cost);
  });
  return costs;
}

SelfMap map_of(const std::vector<Point3f>& points, int scans = 1,
               std::optional<double> max_range_m = 20.0) {
  SelfMap map({});
  ScanPipeline pipeline(TerrainConfig::paper());
  for (int i = 0; i < scans; ++i) pipeline.run({{}, points, max_range_m, {}}, kDown, map);
  return map;
}

constexpr KeyBox kMiddle{{14, -6, -20}, {24, 6, 20}};  // away from the ramp's borders

}  // namespace

TEST_CASE("a scan's ground lies in the map with its cost, and steeper ground costs more") {
  const Costs flat = costs_in(map_of(ramp_ahead(0.0F)), kMiddle);
  CHECK(flat.voxels > 50);
  CHECK(flat.greatest < 0.01F);
  const Costs ramp = costs_in(map_of(ramp_ahead(35.0F)), kMiddle);
  CHECK(ramp.voxels > 50);
  CHECK(ramp.least > 0.15F);
  CHECK(ramp.greatest < 0.35F);
}

TEST_CASE("many scans of the same ground come to the cost of one") {
  const auto points = ramp_ahead(33.0F);
  const SelfMap once = map_of(points);
  const SelfMap often = map_of(points, 300);
  std::size_t compared = 0;
  often.for_each_known_voxel(kMiddle, [&](const VoxelKey& key, VoxelState, float) {
    if (!once.cost(key)) return;
    CHECK(std::abs(*often.cost(key) - *once.cost(key)) <= 2.0F / 65535.0F);
    ++compared;
  });
  CHECK(compared > 50);
}

TEST_CASE("neither order nor density of the points counts") {
  auto points = ramp_ahead(25.0F);
  const SelfMap in_order = map_of(points);
  std::shuffle(points.begin(), points.end(), std::mt19937(1));
  const SelfMap shuffled = map_of(points);
  // Every point three times: in the same cells, with the same centroids.
  std::vector<Point3f> thrice;
  for (int i = 0; i < 3; ++i) thrice.insert(thrice.end(), points.begin(), points.end());
  const SelfMap dense = map_of(thrice);
  std::size_t compared = 0;
  in_order.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState, float) {
    CHECK(in_order.fused_cost(key) == shuffled.fused_cost(key));
    CHECK(in_order.fused_cost(key) == dense.fused_cost(key));
    compared += in_order.cost(key) ? 1 : 0;
  });
  CHECK(compared > 100);
}

TEST_CASE("a robot that stands on a ramp sees the ramp, not a flat floor") {
  // In the robot's own frame the floor is level, and gravity is tilted.
  const float tilt = 35.0F * kPi / 180.0F;
  SelfMap map({});
  ScanPipeline pipeline(TerrainConfig::paper());
  const auto points = ramp_ahead(0.0F);
  pipeline.run({{}, points, 20.0, {}}, {std::sin(tilt), 0.0F, -std::cos(tilt)}, map);
  CHECK(costs_in(map, kMiddle).least > 0.15F);
}

TEST_CASE("points past max range are not judged, and carve nothing that bears a cost") {
  const auto points = ramp_ahead(0.0F);
  const SelfMap map = map_of(points, 1, 2.0);
  CHECK(costs_in(map, {{10, -10, -20}, {17, 10, 20}}).voxels > 20);
  CHECK(costs_in(map, {{20, -10, -20}, {40, 10, 20}}).voxels == 0);
}

TEST_CASE("ground that one ring alone shows has no cost") {
  std::vector<Point3f> ring;
  for (int i = 0; i < 720; ++i) {
    const float angle = static_cast<float>(i) * kPi / 360.0F;
    ring.push_back({8.0F * std::cos(angle), 8.0F * std::sin(angle), -0.55F});
  }
  SelfMap map({});
  ScanPipeline pipeline(TerrainConfig::robust());
  const PipelineReport report = pipeline.run({{}, ring, 20.0, {}}, kDown, map);
  CHECK(report.integration.voxels_hit > 100);
  CHECK(report.costs.voxels_fused == 0);
  CHECK(costs_in(map, {}).voxels == 0);
}

TEST_CASE("far ground counts less than near ground") {
  const auto points = ramp_ahead(0.0F);
  const Lattice lattice(0.1);
  VoxelCostGatherer gatherer;
  TerrainJudge judge(TerrainConfig::paper());
  const auto judged = judge.judge({points, {}});
  const auto near = gatherer.gather(judged, {2.0F, 0.0F, -0.5F}, lattice);
  const float near_information = near.front().information;
  const auto far = gatherer.gather(judged, {-18.0F, 0.0F, -0.5F}, lattice);
  CHECK(near_information > 0.8F);
  CHECK(far.front().information < 0.1F);
  CHECK(far.front().information > 0.0F);
}
