// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/step_height.hpp"

#include <cassert>
#include <cmath>

namespace warren {
namespace {

constexpr float kLeastUpright = 0.70710678F;

// The vector whose product with an offset is its height across the plane along gravity.
Point3f plane_of(const PlaneFits& fits, std::size_t i, const Point3f& gravity) {
  const Point3f n{fits.normal_x[i], fits.normal_y[i], fits.normal_z[i]};
  const float along = n.x * gravity.x + n.y * gravity.y + n.z * gravity.z;
  if (!(std::abs(along) >= kLeastUpright)) return {};
  return {n.x / along, n.y / along, n.z / along};
}

}  // namespace

std::span<const float> StepSearch::find(const ReducedCloud& cloud, const PlaneFits& fits,
                                        std::span<const Evidence> evidence, const Point3f& gravity,
                                        const StepTerm& term) {
  assert(evidence.size() == cloud.size());
  steps_m_.assign(cloud.size(), 0.0F);
  planes_.assign(cloud.size(), Point3f{});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (evidence[i] == Evidence::kPlane) planes_[i] = plane_of(fits, i, gravity);
  }
  // The first level whose neighbourhoods hold the radius everywhere; nothing of it is lost
  // but by rounding at its very edge.
  const TileLevel* level = &cloud.tiles;
  for (std::size_t depth = 0; level->edge_m() < term.radius_m; ++depth) {
    coarser_[depth % 2].assign_parents_of(*level);
    level = &coarser_[depth % 2];
  }
  for (const Tile& tile : level->tiles()) search_tile(cloud, *level, tile, term);
  return steps_m_;
}

void StepSearch::search_tile(const ReducedCloud& cloud, const TileLevel& level, const Tile& tile,
                             const StepTerm& term) {
  std::array<PointRange, 27> ranges;
  const std::size_t count = level.neighbourhood(tile, ranges);
  const Candidates candidates = gatherer_.gather(cloud, std::span(ranges).first(count));
  heights_.reserve(candidates.count);
  for (std::size_t i = tile.points.first; i < tile.points.end; ++i) {
    if (planes_[i] == Point3f{}) continue;
    steps_m_[i] = step_within(candidates, {cloud.point(i), planes_[i], term.radius_m}, heights_);
  }
}

}  // namespace warren
