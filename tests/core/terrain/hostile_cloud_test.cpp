// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/terrain/terrain_judge.hpp"
#include "tests/core/terrain/clouds.hpp"

using namespace warren;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

std::uint64_t judged(const TerrainReport& report) {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : report.evidence) sum += count;
  return sum;
}

}  // namespace

TEST_CASE("an empty scan gives no points") {
  TerrainJudge judge(TerrainConfig::robust());
  CHECK(judge.judge({{}, {}}).empty());
}

TEST_CASE("points that are not finite or too far are left out and counted") {
  TerrainJudge judge(TerrainConfig::paper());
  auto points = test::ramp(0.0F);
  const std::size_t clean = judge.judge({points, {}}).size();
  for (const float bad : {kNaN, kInf, -kInf, 1e30F, -60000.0F}) {
    points.push_back({bad, 0.0F, 0.0F});
    points.push_back({0.0F, 0.0F, bad});
  }
  CHECK(judge.judge({points, {}}).size() == clean);
  CHECK(judge.report().reduction.not_finite == 6);
  CHECK(judge.report().reduction.outside == 4);
}

TEST_CASE("a million points in one place are one point without neighbours") {
  TerrainJudge judge(TerrainConfig::paper());
  const std::vector<Point3f> points(1000000, Point3f{1.01F, -2.02F, 0.33F});
  const auto result = judge.judge({points, {}});
  REQUIRE(result.size() == 1);
  CHECK(result[0].position_layer == Point3f{1.01F, -2.02F, 0.33F});
  CHECK(result[0].evidence == Evidence::kTooFewPoints);
}

TEST_CASE("points scattered over all the space are judged in bounded time") {
  TerrainJudge judge(TerrainConfig::paper());
  std::vector<Point3f> points;
  std::uint32_t state = 1;
  const auto metres = [&state] {
    state = state * 1664525U + 1013904223U;
    return (static_cast<float>(state >> 8) / 16777216.0F - 0.5F) * 100000.0F;
  };
  for (int i = 0; i < 20000; ++i) points.push_back({metres(), metres(), metres()});
  CHECK(judge.judge({points, {}}).size() == 20000);
  CHECK(judge.report().evidence[0] + judge.report().evidence[3] == 20000);
}

TEST_CASE("the corners of the cell space can be judged") {
  TerrainJudge judge(TerrainConfig::paper());
  std::vector<Point3f> points;
  for (const float corner : {-52428.0F, 52428.0F}) {
    for (int i = 0; i < 20; ++i) {
      const float inwards = 1.0F - 0.001F * static_cast<float>(i);
      points.push_back({corner, corner * inwards, corner});
    }
  }
  CHECK(judge.judge({points, {}}).size() == 40);
  CHECK(judge.report().evidence[static_cast<std::size_t>(Evidence::kTooFewPoints)] == 0);
}

TEST_CASE("no bit pattern breaks the judge, and no reduced point goes uncounted") {
  CHECK(rc::check("any floats", [] {
    const auto bits = *rc::gen::arbitrary<std::vector<std::array<std::uint32_t, 3>>>();
    std::vector<Point3f> points = test::arbitrary_cloud(100);
    for (const auto& p : bits) {
      points.push_back(
          {std::bit_cast<float>(p[0]), std::bit_cast<float>(p[1]), std::bit_cast<float>(p[2])});
    }
    const Point3f origin{kNaN, 1e30F, 0.0F};
    TerrainJudge judge(TerrainConfig::robust());
    const auto result = judge.judge({points, origin});
    RC_ASSERT(judged(judge.report()) == result.size());
    for (const JudgedPoint& p : result) RC_ASSERT(p.cost >= 0.0F && p.cost <= 1.0F);
  }));
}
