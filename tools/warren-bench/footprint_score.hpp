// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/terrain/terrain_judge.hpp"

namespace warren {

// The space that a vehicle sweeps when it turns on the spot: an upright cylinder about a place on
// the ground. Its lower end is where ground is no longer the same footprint's.
struct SweptCylinder {
  double radius_m = 0.55;  // half the diagonal of a Husky's body, and of a Spot's
  double above_m = 0.85;   // a Husky's height
  double below_m = 0.4;
  // Of the voxel columns in it, those that need a cost: with fewer, the place has no data.
  double least_known_share = 0.25;
};

// Costs of one scan as a planner reads them from a map: one per voxel, the mean of its points. The
// voxels are the field's (0.2 m), since the planner's thresholds are the field's.
class VoxelCosts {
 public:
  explicit VoxelCosts(double resolution_m = 0.2) : resolution_m_(resolution_m) {}

  // Points without a cost leave no trace.
  void assign(std::span<const JudgedPoint> points);

  // The planner's rule (paper section 2.5: mean below 10 %, max below 20 %) as one number: the
  // larger of the mean and half the maximum of the voxels in the footprint. Below 0.10 exactly
  // where the rule says "valid". None: no data.
  std::optional<double> score(const Point3f& place, const SweptCylinder& cylinder) const;

 private:
  struct Voxel {
    std::int32_t z = 0;
    double mean = 0.0;
  };
  struct Heights {
    double lowest_m = 0.0;
    double highest_m = 0.0;
  };
  struct Tally {
    double sum = 0.0;
    double most = 0.0;
    std::size_t voxels = 0;
    std::size_t columns = 0;
    std::size_t known_columns = 0;
  };

  void add_column(std::uint64_t key, const Heights& heights, Tally& tally) const;
  std::int32_t index_of(double metres) const;
  double centre_m(std::int32_t index) const { return (index + 0.5) * resolution_m_; }

  double resolution_m_;
  std::unordered_map<std::uint64_t, std::vector<Voxel>> columns_;
};

}  // namespace warren
