// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/voxel/voxel_cost.hpp"

namespace warren {

// Four bits for a voxel's cost (paper Eq. 8): 0 is "no data", 1 to 15 are bins that a cost is
// rounded up into. The planner's thresholds 0.10 and 0.20 are edges of bins.
using CostCode = std::uint8_t;
inline constexpr CostCode kNoCostData = 0;
inline constexpr std::array<int, 15> kCostEdges_percent = {5,  10, 15, 20, 25, 30, 35, 40,
                                                           50, 60, 70, 80, 90, 95, 100};

// The planner's thresholds (paper, section 2.5): of the mean under a footprint, and of any of it.
inline constexpr float kSafeMeanCost = 0.10F;
inline constexpr float kSafeMostCost = 0.20F;

// The code of the lowest bin whose upper edge the cost does not exceed.
CostCode encode_cost(const std::optional<FusedCost>& cost);

// The upper edge of the bin: never below what was encoded. Nothing for "no data" and for what is no
// code.
std::optional<float> decode_cost(CostCode code);

// Whether all costs of this code are at most `limit`; "no data" is never safe.
bool is_safe(CostCode code, float limit);

}  // namespace warren
