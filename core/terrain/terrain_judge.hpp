// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/terrain/cloud_reduction.hpp"
#include "core/terrain/neighbourhood.hpp"
#include "core/terrain/plane_fit.hpp"
#include "core/terrain/step_height.hpp"
#include "core/terrain/terrain_cost.hpp"
#include "core/voxel/point.hpp"

namespace warren {

struct TerrainConfig {
  float cell_m = 0.05F;
  NeighbourhoodConfig neighbourhood;
  EvidenceConfig evidence;
  TerrainCostConfig cost;

  // Eq. 3 as printed, neighbourhoods of any width.
  static TerrainConfig paper();
  // The same with roughness and steps, and no data where neighbourhoods are too wide; chosen by
  // `warren-bench terrain-quality`.
  static TerrainConfig robust();
};

struct JudgedPoint {
  Point3f position_layer;
  float cost = 0.0F;  // 0 easy .. 1 impossible; holds only if there is a plane
  Evidence evidence = Evidence::kTooFewPoints;

  bool has_cost() const { return evidence == Evidence::kPlane; }
};

struct TerrainScan {
  std::span<const Point3f> points_layer;
  Point3f origin_layer;                // of the sensor
  Point3f gravity{0.0F, 0.0F, -1.0F};  // unit length, in the layer frame; either sign will do
  std::optional<float> max_range_m{};  // farther points are left out
};

struct TerrainReport {
  ReductionReport reduction;
  EvidenceCounts evidence{};  // of the reduced points
};

// How hard each piece of ground that a scan shows is to drive: one answer per occupied cell of the
// reduction. The order of the scan's points changes nothing. Keeps its buffers between scans: one
// judge per thread.
class TerrainJudge {
 public:
  explicit TerrainJudge(const TerrainConfig& config);

  // Lives until the next call, as does what the accessors give.
  std::span<const JudgedPoint> judge(const TerrainScan& scan);

  const TerrainConfig& config() const { return config_; }
  const TerrainReport& report() const { return report_; }
  const ReducedCloud& reduced() const { return *cloud_; }
  const Neighbourhoods& neighbourhoods() const { return *neighbourhoods_; }
  const PlaneFits& planes() const { return fits_; }
  std::span<const Evidence> evidence() const { return evidence_; }

 private:
  void weigh_evidence(const Point3f& origin);
  void find_steps(const Point3f& gravity);
  void judge_points(const Point3f& gravity);

  TerrainConfig config_;
  CloudReducer reducer_;
  NeighbourSearch neighbour_search_;
  StepSearch step_search_;
  const ReducedCloud* cloud_ = nullptr;
  const Neighbourhoods* neighbourhoods_ = nullptr;
  PlaneFits fits_;
  std::vector<float> ranges_m_;
  std::vector<Evidence> evidence_;
  std::span<const float> steps_m_;  // none if not asked for
  std::vector<JudgedPoint> judged_;
  TerrainReport report_;
};

}  // namespace warren
