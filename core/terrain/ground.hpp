// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "core/terrain/terrain_view.hpp"

namespace warren {

// What a body covers of the ground: a rectangle around the base's origin, length along its x axis.
struct Footprint {
  double length_m = 1.0;
  double width_m = 0.7;
};

struct GroundQuery {
  Eigen::Isometry3d T_layer_base = Eigen::Isometry3d::Identity();
  Footprint footprint;
  Eigen::Vector3d gravity{0.0, 0.0, -1.0};  // unit length, downwards, in the layer frame
  // Ground is looked for along gravity from so far above the footprint to so far below it. What
  // stands in the way higher up is found first and counts as ground.
  double above_m = 0.3;
  double below_m = 0.7;

  // Voxels that all its columns together may be long.
  static constexpr double kVoxelsMax = 131072.0;
  double voxels(double resolution_m) const;
  // Whether its numbers make sense, however many voxels that are.
  bool makes_sense() const;
  bool is_valid(double resolution_m) const {
    return makes_sense() && voxels(resolution_m) <= kVoxelsMax;
  }
};

// The ground under a footprint, by columns along gravity half a voxel apart. Shares are of all
// columns.
struct GroundReport {
  std::size_t columns = 0;
  std::size_t columns_with_ground = 0;
  std::size_t columns_with_cost = 0;
  std::optional<double> mean_cost;  // of the columns with a cost; none if there are none
  std::optional<double> max_cost;
  double unknown_share = 1.0;  // no ground found, or ground without a cost
  double stairs_share = 0.0;
  double step_m = 0.0;  // greatest difference in height of neighbouring columns, in whole voxels
};

// Precondition: query.is_valid(). Paper, section 2.5.
GroundReport ground(const TerrainView& map, const GroundQuery& query);

// The paper's thresholds (section 2.5).
struct ValidityRule {
  double mean_below = 0.10;
  double max_below = 0.20;
  double stairs_from = 0.30;
  // Columns without a cost that are put up with; they count as impossible in the mean even then.
  double unknown_up_to = 0.0;
};

enum class Validity : std::uint8_t {
  kTraversable,
  kStairs,   // enough stairs for one who can climb them, whatever the cost
  kUnknown,  // what is known is easy, but not enough is known
  kTooHard,
};
const char* name_of(Validity validity);  // snake_case
inline bool is_valid(Validity validity) {
  return validity == Validity::kTraversable || validity == Validity::kStairs;
}

// Whether a body may stand there. What has no cost is never taken for easy.
Validity validity(const GroundReport& report, bool stair_capable, const ValidityRule& rule = {});
Validity validity(const TerrainView& map, const GroundQuery& query, bool stair_capable,
                  const ValidityRule& rule = {});

}  // namespace warren
