// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/voxel/key.hpp"

namespace warren {

// How hard a voxel's ground is to drive, as one scan shows it.
struct VoxelCost {
  VoxelKey key;
  float cost = 0.0F;         // 0 easy .. 1 impossible
  float information = 1.0F;  // 0..1: how much this scan can tell, 1 a scan from close by
};

enum class CostRule : std::uint8_t {
  kInformation,  // average weighted by information, the past's weight capped
  kPaper,        // Eq. 4 as printed: the higher the occupancy, the less a new cost counts
};

struct CostFusionConfig {
  CostRule rule = CostRule::kInformation;
  // The past weighs at most so many close scans. More outvotes outliers better; less follows a
  // change sooner: what is left of one after n close scans is (1 - 1 / (limit + 1))^n.
  float information_limit = 15.0F;
};

// A fused cost in fixed point: the same on every CPU.
struct FusedCost {
  static constexpr std::uint16_t kImpossible = 65535;

  std::uint16_t cost = 0;         // of 65535
  std::uint16_t information = 0;  // in kInformationSteps per close scan
  friend bool operator==(const FusedCost&, const FusedCost&) = default;

  float value() const { return static_cast<float>(cost) / kImpossible; }
};

// One voxel's cost after one more scan.
class CostFusion {
 public:
  static constexpr int kInformationSteps = 256;

  // Precondition: information_limit lies in 1 .. 255.
  explicit CostFusion(const CostFusionConfig& config);

  // The first cost of a voxel is taken as it is; a NaN counts as impossible.
  FusedCost first(const VoxelCost& measured) const;
  // Whether next() looks at the occupancy.
  bool weighs_occupancy() const { return rule_ == CostRule::kPaper; }
  // `occupancy` is the voxel's probability after this scan.
  FusedCost next(const FusedCost& fused, const VoxelCost& measured, double occupancy) const;

 private:
  CostRule rule_;
  int information_limit_;  // in steps
};

}  // namespace warren
