// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace warren {

// Whether a point's neighbourhood carries a plane, and if not, why.
enum class Evidence : std::uint8_t {
  kPlane,
  kTooFewPoints,  // the cloud is smaller than one neighbourhood
  kTooWide,       // the nearest reach too far for the range
  kRing,          // the nearest lie on one line, one scan ring say: any normal would fit
};
inline constexpr std::size_t kEvidenceCount = 4;
// snake_case, as it stands in status and metrics.
const char* name_of(Evidence evidence);

using EvidenceCounts = std::array<std::uint64_t, kEvidenceCount>;

// How wide a neighbourhood may be, by the range of its point from the sensor.
struct WidthLimit {
  float base_m = 0.5F;
  float per_range = 0.03F;

  float radius_m(float range_m) const { return base_m + per_range * range_m; }
};

struct EvidenceConfig {
  // Variances of the neighbourhood, second to first, below which it is a ring.
  float least_spread_ratio = 0.01F;
  std::optional<WidthLimit> width;  // none: any width will do
};

// A height that costs nothing up to `harmless_m` and makes the cost 1 by itself at `critical_m`.
struct HeightLimits {
  float harmless_m = 0.0F;
  float critical_m = 1.0F;

  float share_of(float height_m) const {
    return std::max(0.0F, height_m - harmless_m) / (critical_m - harmless_m);
  }
};

// Standard deviation of the neighbourhood from its plane.
struct RoughnessTerm {
  HeightLimits limits{0.06F, 0.20F};
};

// Height differences across the plane within a radius. Small ones are harmless: every vehicle
// takes them, and a lidar's noise explains them.
struct StepTerm {
  HeightLimits limits{0.05F, 0.20F};
  float radius_m = 0.2F;
};

struct TerrainCostConfig {
  float slope_gain = 20.0F;
  float curvature_gain = 2.0F;
  float saturation = 0.5F;  // what counts as cost 1; 1.0 for short-range depth cameras
  std::optional<RoughnessTerm> roughness;
  std::optional<StepTerm> step;
};

struct GroundShape {
  float normal_along_gravity = 1.0F;  // n . k, of either sign
  float curvature = 0.0F;
  float roughness_m = 0.0F;
  float step_m = 0.0F;
};

// The paper's Eq. 3, and the optional terms added to its sum: 0 easy, 1 impossible.
float terrain_cost(const GroundShape& shape, const TerrainCostConfig& config);

}  // namespace warren
