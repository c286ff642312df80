// SPDX-License-Identifier: Apache-2.0
#include "core/layer/cost_code.hpp"

#include <doctest/doctest.h>

using namespace warren;

TEST_CASE("no code lies below the cost that it stands for, and none is a bin too high") {
  for (int cost = 0; cost <= FusedCost::kImpossible; ++cost) {
    const FusedCost fused{static_cast<std::uint16_t>(cost), 1};
    const CostCode code = encode_cost(fused);
    REQUIRE(code >= 1);
    REQUIRE(code <= 15);
    const int edge = kCostEdges_percent[code - std::size_t{1}];
    REQUIRE(cost * 100 <= edge * int{FusedCost::kImpossible});
    const int edge_below = code == 1 ? -1 : kCostEdges_percent[code - std::size_t{2}];
    REQUIRE(cost * 100 > edge_below * int{FusedCost::kImpossible});
  }
}

TEST_CASE("codes keep the planner's thresholds") {
  const auto code_of = [](double cost) {
    return encode_cost(FusedCost{static_cast<std::uint16_t>(cost * FusedCost::kImpossible), 1});
  };
  CHECK(is_safe(code_of(0.0999), 0.10F));
  CHECK(is_safe(encode_cost(FusedCost{13107, 1}), 0.20F));        // 0.2 exactly
  CHECK_FALSE(is_safe(encode_cost(FusedCost{13108, 1}), 0.20F));  // a step more
  CHECK_FALSE(is_safe(code_of(0.101), 0.10F));
  CHECK(*decode_cost(code_of(1.0)) == 1.0F);
}

TEST_CASE("no data has a code of its own, and is not safe at any limit") {
  CHECK(encode_cost(std::nullopt) == kNoCostData);
  CHECK_FALSE(decode_cost(kNoCostData));
  CHECK_FALSE(is_safe(kNoCostData, 1.0F));
  CHECK(encode_cost(FusedCost{0, 1}) != kNoCostData);
  for (int code = 16; code < 256; ++code) {
    CHECK_FALSE(decode_cost(static_cast<CostCode>(code)));
    CHECK_FALSE(is_safe(static_cast<CostCode>(code), 1.0F));
  }
}
