// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/terrain_quality.hpp"

#include <algorithm>

namespace warren {
namespace {

// The results of one vehicle lie together, range bin by range bin.
std::vector<TerrainQuality> empty_results(const LabelledRun& run, const NamedProfile& profile,
                                          const TerrainQualityOptions& options) {
  std::vector<TerrainQuality> results;
  for (const world::Vehicle& vehicle : options.run.vehicles) {
    for (const RangeBin& bin : kRangeBins) {
      results.push_back({profile.name, run.world, vehicle.name, bin, {}, 0});
    }
  }
  return results;
}

std::size_t bin_of(double range_m) {
  const auto bin = std::find_if(kRangeBins.begin(), kRangeBins.end(),
                                [&](const RangeBin& b) { return range_m < b.high_m; });
  return std::min(static_cast<std::size_t>(bin - kRangeBins.begin()), kRangeBins.size() - 1);
}

void count(TerrainQuality& result, GroundLabel label, std::optional<double> score) {
  if (label == GroundLabel::kMixed) {
    ++result.mixed;
  } else {
    result.agreement.add(score, label == GroundLabel::kHazard);
  }
}

}  // namespace

std::vector<TerrainQuality> judge_profile(const LabelledRun& run, const NamedProfile& profile,
                                          const TerrainQualityOptions& options) {
  std::vector<TerrainQuality> results = empty_results(run, profile, options);
  TerrainJudge judge(profile.config);
  VoxelCosts costs;
  for (const LabelledScan& scan : run.scans) {
    costs.assign(judge.judge({scan.points_world, scan.origin_world}));
    for (const PlaceInView& seen : scan.in_view) {
      const GroundPlace& place = run.places[seen.place];
      const auto score = costs.score(place.position_world, options.cylinder);
      for (std::size_t v = 0; v < place.by_vehicle.size(); ++v) {
        count(results[v * kRangeBins.size() + bin_of(seen.range_m)], place.by_vehicle[v], score);
      }
    }
  }
  return results;
}

void sort_worst_first(std::span<TerrainQuality> results) {
  const auto rank = [](const TerrainQuality& quality) {
    return quality.agreement.roc_auc().value_or(2.0);  // after all that there are
  };
  std::stable_sort(results.begin(), results.end(),
                   [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

tl::expected<std::vector<TerrainQuality>, std::string> bench_terrain_quality(
    const TerrainQualityOptions& options) {
  std::vector<TerrainQuality> results;
  for (const std::string& name : options.worlds) {
    const auto world = world::make_world({name, options.run.seed, 0.0});
    if (!world) return tl::unexpected(world.error());
    const LabelledRun run = explore_and_label(*world, options.run);
    for (const NamedProfile& profile : options.profiles) {
      const auto judged = judge_profile(run, profile, options);
      results.insert(results.end(), judged.begin(), judged.end());
    }
  }
  sort_worst_first(results);
  return results;
}

}  // namespace warren
