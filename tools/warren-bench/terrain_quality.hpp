// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/terrain/terrain_judge.hpp"
#include "tools/warren-bench/footprint_score.hpp"
#include "tools/warren-bench/label_agreement.hpp"
#include "tools/warren-bench/labelled_run.hpp"

namespace warren {

struct RangeBin {
  double low_m = 0.0;
  double high_m = 0.0;
};
// Distances of places from the sensor at which costs are judged apart.
inline constexpr std::array<RangeBin, 4> kRangeBins = {
    {{0.0, 2.0}, {2.0, 5.0}, {5.0, 10.0}, {10.0, 20.0}}};

struct NamedProfile {
  std::string name;
  TerrainConfig config;
};

// One profile's costs against what vehicles can do, for places within one range bin of the sensor.
struct TerrainQuality {
  std::string profile;
  std::string world;
  std::string vehicle;
  RangeBin bin;
  LabelAgreement agreement;
  std::uint64_t mixed = 0;  // seen too, but not judged by
};

struct TerrainQualityOptions {
  std::vector<std::string> worlds = {"cave", "tunnel", "urban", "mine"};
  std::vector<NamedProfile> profiles = {{"paper", TerrainConfig::paper()},
                                        {"robust", TerrainConfig::robust()}};
  LabelledRunOptions run;
  SweptCylinder cylinder;
};

// Do costs tell where vehicles can drive? One robot explores each world; every place of ground that
// a scan could see is scored by that scan alone, as a planner would read it (VoxelCosts::score),
// and compared with what happens to a vehicle lowered there onto the world's mesh (GroundLabel). A
// place counts once per scan that has it in view.
tl::expected<std::vector<TerrainQuality>, std::string> bench_terrain_quality(
    const TerrainQualityOptions& options);

// One profile on one run: a result per vehicle and range bin.
std::vector<TerrainQuality> judge_profile(const LabelledRun& run, const NamedProfile& profile,
                                          const TerrainQualityOptions& options);

// The worst separation of hazards from safe places first; last, those without both.
void sort_worst_first(std::span<TerrainQuality> results);

std::string to_text(const std::vector<TerrainQuality>& results);
std::string to_json(const std::vector<TerrainQuality>& results,
                    const TerrainQualityOptions& options);

}  // namespace warren
