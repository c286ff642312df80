// SPDX-License-Identifier: Apache-2.0
#include "core/layer/cost_code.hpp"

#include <algorithm>

namespace warren {

CostCode encode_cost(const std::optional<FusedCost>& cost) {
  if (!cost) return kNoCostData;
  const int scaled = cost->cost * 100;
  const auto* const edge =
      std::find_if(kCostEdges_percent.begin(), kCostEdges_percent.end(),
                   [&](int percent) { return scaled <= percent * FusedCost::kImpossible; });
  return static_cast<CostCode>(edge - kCostEdges_percent.begin() + 1);
}

std::optional<float> decode_cost(CostCode code) {
  if (code == kNoCostData || code > kCostEdges_percent.size()) return std::nullopt;
  return static_cast<float>(kCostEdges_percent[code - std::size_t{1}]) / 100.0F;
}

bool is_safe(CostCode code, float limit) {
  const auto cost = decode_cost(code);
  return cost && *cost <= limit;
}

}  // namespace warren
