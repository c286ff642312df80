// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/terrain_quality.hpp"

#include <doctest/doctest.h>

using namespace warren;

namespace {

// Flat ground; nothing is judged but places beside each other, of known labels and ranges.
LabelledRun run_on_flat_ground() {
  LabelledScan scan;
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y) {
      scan.points_world.push_back(
          {0.05F * static_cast<float>(x), 0.05F * static_cast<float>(y), 0.0F});
    }
  }
  scan.origin_world = {1.0F, 1.0F, 0.75F};
  scan.in_view = {{0, 1.0}, {1, 1.0}, {2, 1.0}, {0, 3.0}, {3, 12.0}};
  const Point3f middle{1.0F, 1.0F, 0.0F};
  const Point3f far_off{50.0F, 1.0F, 0.0F};
  return {"flat",
          {{middle, {GroundLabel::kSafe}},
           {middle, {GroundLabel::kHazard}},
           {middle, {GroundLabel::kMixed}},
           {far_off, {GroundLabel::kSafe}}},
          {scan}};
}

}  // namespace

TEST_CASE("places are counted by range bin, label and data") {
  const auto results = judge_profile(run_on_flat_ground(), {"paper", TerrainConfig::paper()}, {});
  REQUIRE(results.size() == kRangeBins.size());
  const LabelAgreement& near = results[0].agreement;
  CHECK(near.safe_count() == 1);
  CHECK(near.hazard_count() == 1);
  CHECK(results[0].mixed == 1);
  CHECK(near.false_safe(0.10) == 1.0);  // the flat ground hides the hazard
  CHECK(near.false_hazard(0.10) == 0.0);
  CHECK(near.roc_auc() == doctest::Approx(0.5));
  CHECK(results[1].agreement.safe_count() == 1);
  CHECK(results[3].agreement.safe_without_data() == 1.0);
}

TEST_CASE("the worst separation comes first, and last what cannot be told") {
  std::vector<TerrainQuality> results(3);
  results[1].agreement.add(0.5, true);
  results[1].agreement.add(0.4, false);
  results[2].agreement.add(0.3, true);
  results[2].agreement.add(0.4, false);
  sort_worst_first(results);
  CHECK(results[0].agreement.roc_auc() == 0.0);
  CHECK(results[1].agreement.roc_auc() == 1.0);
  CHECK_FALSE(results[2].agreement.roc_auc());
}

TEST_CASE("a simulated run has hazards, safe ground and the same numbers every time") {
  TerrainQualityOptions options;
  options.worlds = {"tunnel"};
  options.run.duration_s = 2.0;
  options.run.place_spacing_m = 0.5;
  const auto results = bench_terrain_quality(options);
  REQUIRE(results);
  CHECK(results->size() == 2 * kRangeBins.size());
  std::uint64_t safe = 0;
  std::uint64_t hazards = 0;
  for (const TerrainQuality& quality : *results) {
    safe += quality.agreement.safe_count();
    hazards += quality.agreement.hazard_count();
  }
  CHECK(safe > 100);
  CHECK(hazards > 100);
  const auto again = bench_terrain_quality(options);
  REQUIRE(again);
  REQUIRE(again->size() == results->size());
  for (std::size_t i = 0; i < results->size(); ++i) {
    CHECK((*results)[i].agreement.roc_auc() == (*again)[i].agreement.roc_auc());
    CHECK((*results)[i].agreement.false_safe(0.10) == (*again)[i].agreement.false_safe(0.10));
  }
}

TEST_CASE("an unknown world is an error that says so") {
  TerrainQualityOptions options;
  options.worlds = {"moon"};
  CHECK_FALSE(bench_terrain_quality(options));
}
