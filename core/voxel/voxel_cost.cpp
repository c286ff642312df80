// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/voxel_cost.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace warren {
namespace {

// Rounded up: what is stored is never easier than what was measured.
int fixed_cost(float cost) {
  if (std::isnan(cost)) return FusedCost::kImpossible;
  return static_cast<int>(std::ceil(std::clamp(cost, 0.0F, 1.0F) * float{FusedCost::kImpossible}));
}

// At least one step: a cost that was measured says something.
int fixed_information(float information) {
  if (std::isnan(information)) return 1;
  return std::max(1, static_cast<int>(std::lround(std::clamp(information, 0.0F, 1.0F) *
                                                  CostFusion::kInformationSteps)));
}

FusedCost fused_cost(int cost, int information) {
  return {static_cast<std::uint16_t>(cost), static_cast<std::uint16_t>(information)};
}

// part / whole of the way, rounded away from zero so that no small remainder stays for ever.
int share_of_way(int way, int part, int whole) {
  const auto exact = static_cast<std::int64_t>(std::abs(way)) * part;
  const auto steps = static_cast<int>((exact + whole - 1) / whole);
  return way < 0 ? -steps : steps;
}

}  // namespace

CostFusion::CostFusion(const CostFusionConfig& config)
    : rule_(config.rule),
      information_limit_(
          static_cast<int>(std::lround(config.information_limit * kInformationSteps))) {
  assert(config.information_limit >= 1.0F && config.information_limit <= 255.0F);
}

FusedCost CostFusion::first(const VoxelCost& measured) const {
  return fused_cost(fixed_cost(measured.cost), fixed_information(measured.information));
}

FusedCost CostFusion::next(const FusedCost& fused, const VoxelCost& measured,
                           double occupancy) const {
  const int before = fused.cost;
  const int way = fixed_cost(measured.cost) - before;
  const int information = fixed_information(measured.information);
  const int all = fused.information + information;
  const int kept = std::min(all, information_limit_);
  if (rule_ == CostRule::kPaper) {
    return fused_cost(before + static_cast<int>(std::lround(way * (1.0 - occupancy))), kept);
  }
  return fused_cost(before + share_of_way(way, information, all), kept);
}

}  // namespace warren
