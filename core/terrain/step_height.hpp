// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/terrain/candidate_gatherer.hpp"
#include "core/terrain/cloud_reduction.hpp"
#include "core/terrain/plane_fit.hpp"
#include "core/terrain/step_kernel.hpp"
#include "core/terrain/terrain_cost.hpp"

namespace warren {

// How far the ground around each point leaves the plane through it, measured along gravity: the
// plane is taken off so that a ramp is no step. Not asked where the plane is steeper than 45
// degrees (0 there): the slope says enough, and a wall's own plane explains nothing about ground.
class StepSearch {
 public:
  // Metres per point; lives until the next call. `gravity` is of unit length.
  std::span<const float> find(const ReducedCloud& cloud, const PlaneFits& fits,
                              std::span<const Evidence> evidence, const Point3f& gravity,
                              const StepTerm& term);

 private:
  void search_tile(const ReducedCloud& cloud, const TileLevel& level, const Tile& tile,
                   const StepTerm& term);

  std::vector<float> steps_m_;
  std::vector<Point3f> planes_;  // per point; zero where a step is not asked for
  std::array<TileLevel, 2> coarser_;
  CandidateGatherer gatherer_;
  Heights heights_;
};

}  // namespace warren
