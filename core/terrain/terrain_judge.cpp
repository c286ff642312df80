// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/terrain_judge.hpp"

#include <cmath>

namespace warren {
namespace {

Evidence evidence_of(NeighbourhoodState state) {
  switch (state) {
    case NeighbourhoodState::kFound:
      return Evidence::kPlane;
    case NeighbourhoodState::kTooFew:
      return Evidence::kTooFewPoints;
    case NeighbourhoodState::kTooWide:
      return Evidence::kTooWide;
  }
  return Evidence::kTooFewPoints;
}

}  // namespace

TerrainConfig TerrainConfig::paper() { return {}; }

TerrainConfig TerrainConfig::robust() {
  TerrainConfig config;
  config.evidence.width = WidthLimit{};
  config.neighbourhood.max_radius_m = config.evidence.width->radius_m(20.0F);
  config.cost.roughness = RoughnessTerm{};
  config.cost.step = StepTerm{};
  return config;
}

TerrainJudge::TerrainJudge(const TerrainConfig& config)
    : config_(config), reducer_(config.cell_m), neighbour_search_(config.neighbourhood) {}

std::span<const JudgedPoint> TerrainJudge::judge(const TerrainScan& scan) {
  cloud_ = scan.max_range_m
               ? &reducer_.reduce(scan.points_layer, {scan.origin_layer, *scan.max_range_m})
               : &reducer_.reduce(scan.points_layer);
  neighbourhoods_ = &neighbour_search_.find(*cloud_);
  fit_planes(*neighbourhoods_, config_.neighbourhood.neighbours, fits_);
  weigh_evidence(scan.origin_layer);
  find_steps(scan.gravity);
  judge_points(scan.gravity);
  return judged_;
}

void TerrainJudge::weigh_evidence(const Point3f& origin) {
  report_ = {reducer_.report(), {}};
  evidence_.resize(cloud_->size());
  ranges_m_.resize(cloud_->size());
  const EvidenceConfig& config = config_.evidence;
  for (std::size_t i = 0; i < cloud_->size(); ++i) {
    ranges_m_[i] = std::sqrt(squared_distance(cloud_->point(i), origin));
    Evidence evidence = evidence_of(neighbourhoods_->states[i]);
    if (evidence == Evidence::kPlane) {
      const float radius_m = std::sqrt(neighbourhoods_->squared_radius[i]);
      // Not "less than": of points that all coincide both variances are 0, and that is no plane.
      if (!(fits_.l1[i] > config.least_spread_ratio * fits_.l2[i])) evidence = Evidence::kRing;
      if (config.width && radius_m > config.width->radius_m(ranges_m_[i])) {
        evidence = Evidence::kTooWide;
      }
    }
    evidence_[i] = evidence;
    ++report_.evidence[static_cast<std::size_t>(evidence)];
  }
}

void TerrainJudge::find_steps(const Point3f& gravity) {
  steps_m_ = {};
  if (!config_.cost.step) return;
  steps_m_ = step_search_.find(*cloud_, fits_, evidence_, gravity, *config_.cost.step);
}

void TerrainJudge::judge_points(const Point3f& gravity) {
  judged_.resize(cloud_->size());
  for (std::size_t i = 0; i < judged_.size(); ++i) {
    const GroundShape shape{fits_.normal_x[i] * gravity.x + fits_.normal_y[i] * gravity.y +
                                fits_.normal_z[i] * gravity.z,
                            fits_.curvature[i], std::sqrt(fits_.l0[i]),
                            steps_m_.empty() ? 0.0F : steps_m_[i]};
    const bool has_cost = evidence_[i] == Evidence::kPlane;
    judged_[i] = {cloud_->point(i), has_cost ? terrain_cost(shape, config_.cost) : 0.0F,
                  evidence_[i]};
  }
}

}  // namespace warren
