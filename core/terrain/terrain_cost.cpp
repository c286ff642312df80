// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/terrain_cost.hpp"

#include <cmath>

namespace warren {

const char* name_of(Evidence evidence) {
  switch (evidence) {
    case Evidence::kPlane:
      return "plane";
    case Evidence::kTooFewPoints:
      return "too_few_points";
    case Evidence::kTooWide:
      return "too_wide";
    case Evidence::kRing:
      return "ring";
  }
  return "unknown";
}

float terrain_cost(const GroundShape& shape, const TerrainCostConfig& config) {
  // Rounding may make a unit vector a little longer.
  const float tilt = std::max(0.0F, 1.0F - std::abs(shape.normal_along_gravity));
  float share = (config.slope_gain * tilt * tilt * tilt + config.curvature_gain * shape.curvature) /
                config.saturation;
  if (config.roughness) share += config.roughness->limits.share_of(shape.roughness_m);
  if (config.step) share += config.step->limits.share_of(shape.step_m);
  return std::clamp(share, 0.0F, 1.0F);
}

}  // namespace warren
