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
  float base_m = 0.25F;
  float per_range = 0.05F;

  float radius_m(float range_m) const { return base_m + per_range * range_m; }
};

struct EvidenceConfig {
  // Variances of the neighbourhood, second to first, below which it is a ring.
  float least_spread_ratio = 0.01F;
  std::optional<WidthLimit> width;  // none: any width will do
};

// What the noise of a lidar explains of a height difference.
struct NoiseFloor {
  float least_m = 0.01F;
  float per_range = 0.004F;

  float height_m(float range_m) const { return std::max(least_m, per_range * range_m); }
};

// Standard deviation from the plane beyond the noise floor; at the critical value the term alone
// makes the cost 1.
struct RoughnessTerm {
  float critical_m = 0.05F;
};

// Height differences across the plane within two radii, beyond the noise floor; the larger counts.
struct StepTerm {
  float critical_m = 0.12F;
  std::array<float, 2> radii_m{0.125F, 0.4F};  // ascending
};

struct TerrainCostConfig {
  float slope_gain = 20.0F;
  float curvature_gain = 2.0F;
  float saturation = 0.5F;  // what counts as cost 1; 1.0 for short-range depth cameras
  NoiseFloor noise;
  std::optional<RoughnessTerm> roughness;
  std::optional<StepTerm> step;
};

struct GroundShape {
  float normal_along_gravity = 1.0F;  // n . k, of either sign
  float curvature = 0.0F;
  float roughness_m = 0.0F;
  float step_m = 0.0F;
  float range_m = 0.0F;
};

// The paper's Eq. 3, and the optional terms added to its sum: 0 easy, 1 impossible.
float terrain_cost(const GroundShape& shape, const TerrainCostConfig& config);

}  // namespace warren
