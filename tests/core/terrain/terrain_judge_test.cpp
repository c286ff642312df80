// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/terrain_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include <doctest/doctest.h>

#include "tests/core/terrain/clouds.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;

namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;

float mean_cost(std::span<const JudgedPoint> points) {
  float sum = 0.0F;
  float count = 0.0F;
  for (const JudgedPoint& p : points) {
    if (!p.has_cost()) continue;
    sum += p.cost;
    count += 1.0F;
  }
  REQUIRE(count > 0.0F);
  return sum / count;
}

std::uint64_t count_of(const TerrainJudge& judge, Evidence evidence) {
  return judge.report().evidence[static_cast<std::size_t>(evidence)];
}

// Points on floor circles about the sensor, as a level lidar of few rings sees far ground.
std::vector<Point3f> rings(std::initializer_list<float> radii_m, float spacing_m) {
  std::vector<Point3f> points;
  for (const float radius : radii_m) {
    const int count = static_cast<int>(2.0F * std::numbers::pi_v<float> * radius / spacing_m);
    for (int i = 0; i < count; ++i) {
      const float yaw =
          2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(count);
      points.push_back({radius * std::cos(yaw), radius * std::sin(yaw), -0.6F});
    }
  }
  return points;
}

bool same(std::span<const JudgedPoint> a, std::span<const JudgedPoint> b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const JudgedPoint& p, const JudgedPoint& q) {
        return p.position_layer == q.position_layer && p.cost == q.cost && p.evidence == q.evidence;
      });
}

}  // namespace

TEST_CASE("level ground is easy and a wall is impossible") {
  TerrainJudge judge(TerrainConfig::paper());
  CHECK(mean_cost(judge.judge({test::ramp(0.0F), {}})) < 1e-6F);
  CHECK(mean_cost(judge.judge({test::ramp(90.0F * kDegree), {}})) == 1.0F);
}

TEST_CASE("a ramp costs by its angle to gravity, also for a robot that stands on it") {
  TerrainJudge judge(TerrainConfig::paper());
  const float slope = 34.0F * kDegree;
  CHECK(mean_cost(judge.judge({test::ramp(slope), {}})) == doctest::Approx(0.20).epsilon(0.02));
  // The robot on the ramp: its own frame lies in the ramp, gravity is what is tilted.
  const Point3f tilted_gravity{-std::sin(slope), 0.0F, -std::cos(slope)};
  const auto flat = test::ramp(0.0F);
  CHECK(mean_cost(judge.judge({flat, {}, tilted_gravity})) == doctest::Approx(0.20).epsilon(0.02));
  // What the predecessor did: the lidar's own axis for gravity.
  CHECK(mean_cost(judge.judge({flat, {}})) < 1e-6F);
}

TEST_CASE("either sign of gravity will do") {
  for (const TerrainConfig& config : {TerrainConfig::paper(), TerrainConfig::robust()}) {
    TerrainJudge judge(config);
    const auto points = test::ramp(0.4F);
    const auto down = judge.judge({points, {}, {0.0F, 0.0F, -1.0F}});
    const std::vector<JudgedPoint> kept(down.begin(), down.end());
    const auto up = judge.judge({points, {}, {0.0F, 0.0F, 1.0F}});
    for (std::size_t i = 0; i < up.size(); ++i) {
      CHECK(up[i].cost == doctest::Approx(kept[i].cost).epsilon(1e-5));
    }
  }
}

TEST_CASE("steeper ramps cost more") {
  for (const TerrainConfig& config : {TerrainConfig::paper(), TerrainConfig::robust()}) {
    TerrainJudge judge(config);
    float last = -1e-3F;
    for (int step = 0; step <= 11; ++step) {
      const float degrees = 4.0F * static_cast<float>(step);
      const float cost = mean_cost(judge.judge({test::ramp(degrees * kDegree), {}}));
      CHECK(cost >= last);
      last = cost;
    }
    CHECK(last > 0.8F);
  }
}

TEST_CASE("scan rings far apart give no data, not a cost") {
  const auto scan = rings({8.0F, 10.0F, 13.0F}, 0.06F);
  TerrainJudge paper(TerrainConfig::paper());
  const std::size_t points = paper.judge({scan, {}}).size();
  CHECK(points > 1000);
  CHECK(count_of(paper, Evidence::kRing) == points);
  // In profile robust some neighbourhoods along the rings are too wide besides.
  TerrainJudge robust(TerrainConfig::robust());
  robust.judge({scan, {}});
  CHECK(count_of(robust, Evidence::kRing) + count_of(robust, Evidence::kTooWide) == points);
}

TEST_CASE("a line of points gives no data") {
  TerrainJudge judge(TerrainConfig::paper());
  std::vector<Point3f> line;
  for (int i = 0; i < 100; ++i) line.push_back({0.1F * static_cast<float>(i), 1.0F, 2.0F});
  judge.judge({line, {}});
  CHECK(count_of(judge, Evidence::kRing) == 100);
}

TEST_CASE("fewer points than a neighbourhood give no data") {
  TerrainJudge judge(TerrainConfig::paper());
  auto points = test::ramp(0.0F, 5);
  CHECK(judge.judge({points, {}}).size() == 25);
  CHECK(count_of(judge, Evidence::kPlane) == 25);
  points.resize(23);
  judge.judge({points, {}});
  CHECK(count_of(judge, Evidence::kTooFewPoints) == 23);
}

TEST_CASE("a neighbourhood too wide for its range gives no data in profile robust") {
  const auto sparse = test::ramp(0.0F, 10, 0.2F);  // 24 points within some 0.6 m
  TerrainJudge robust(TerrainConfig::robust());
  robust.judge({sparse, {1.0F, 1.0F, 0.5F}});
  CHECK(count_of(robust, Evidence::kTooWide) == 100);
  robust.judge({sparse, {20.0F, 1.0F, 0.5F}});  // at 20 m nobody could ask for more
  CHECK(count_of(robust, Evidence::kPlane) > 90);
  TerrainJudge paper(TerrainConfig::paper());
  paper.judge({sparse, {1.0F, 1.0F, 0.5F}});
  CHECK(count_of(paper, Evidence::kPlane) == 100);
}

TEST_CASE("a step costs in profile robust before the plane fit sees it") {
  auto points = test::ramp(0.0F);
  for (Point3f& p : points) {
    p = {p.x + 0.02F, p.y + 0.02F, p.x > 1.01F ? 0.10F : 0.0F};  // each in a cell of its own
  }
  TerrainJudge robust(TerrainConfig::robust());
  TerrainJudge paper(TerrainConfig::paper());
  const auto costs_near = [](std::span<const JudgedPoint> judged) {
    std::vector<JudgedPoint> near;
    for (const JudgedPoint& p : judged) {
      if (p.position_layer.x > 0.90F && p.position_layer.x < 0.94F) near.push_back(p);
    }
    return mean_cost(near);
  };
  CHECK(costs_near(paper.judge({points, {}})) < 0.01F);
  CHECK(costs_near(robust.judge({points, {}})) > 0.3F);
  CHECK(mean_cost(robust.judge({test::ramp(0.0F), {}})) < 0.01F);
  // A ramp is no step.
  const float slope = 15.0F * kDegree;
  CHECK(mean_cost(robust.judge({test::ramp(slope), {}})) < 0.02F);
}

TEST_CASE("a step that every vehicle takes costs what the paper's profile says") {
  auto points = test::ramp(0.0F);
  for (Point3f& p : points) p.z = p.x > 1.01F ? 0.04F : 0.0F;
  TerrainJudge robust(TerrainConfig::robust());
  TerrainJudge paper(TerrainConfig::paper());
  CHECK(same(robust.judge({points, {}}), paper.judge({points, {}})));
}

TEST_CASE("a wall is no step for the floor a quarter of a metre before it") {
  auto points = test::ramp(0.0F, 21);  // up to x = 1
  for (Point3f p : test::ramp(90.0F * kDegree, 21)) {
    p.x += 1.0F;
    points.push_back(p);
  }
  TerrainJudge robust(TerrainConfig::robust());
  for (const JudgedPoint& p : robust.judge({points, {}})) {
    if (p.position_layer.x < 0.76F) CHECK(p.cost < 0.01F);
  }
}

TEST_CASE("the order of points and earlier scans change no bit") {
  auto scan = test::scan_room({}, {32, 256}, {0.1F, 0.2F, 0.3F}, 4);
  for (const TerrainConfig& config : {TerrainConfig::paper(), TerrainConfig::robust()}) {
    TerrainJudge first(config);
    TerrainJudge second(config);
    const auto wanted = first.judge({scan.points_layer, scan.origin_layer});
    CHECK(wanted.size() > 1000);
    second.judge({test::ramp(0.5F, 100), {}});
    std::shuffle(scan.points_layer.begin(), scan.points_layer.end(), std::mt19937(5));
    CHECK(same(wanted, second.judge({scan.points_layer, scan.origin_layer})));
  }
}

TEST_CASE("every instruction set judges alike, bit by bit") {
  const auto scan = test::scan_room({}, {32, 256}, {0.1F, 0.2F, 0.3F}, 6);
  TerrainJudge wanted(TerrainConfig::robust());
  const auto judged = wanted.judge({scan.points_layer, scan.origin_layer});
  test::on_every_target([&] {
    TerrainJudge judge(TerrainConfig::robust());
    CHECK(same(judged, judge.judge({scan.points_layer, scan.origin_layer})));
  });
}
