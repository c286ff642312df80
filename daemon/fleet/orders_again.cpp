// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/orders_again.hpp"

#include <algorithm>
#include <set>

namespace warren {
namespace {

// Whether the later of the two decides about some layer.
bool compete(const Order& a, const Order& b) {
  const bool same_matter = (a.verb == Order::Verb::kAlign) == (b.verb == Order::Verb::kAlign);
  return a.node == b.node && same_matter && (a.layer == b.layer || !a.layer || !b.layer);
}

}  // namespace

std::vector<Order> orders_to_give_again(const std::vector<Order>& of_this_life,
                                        const std::vector<Order>& of_earlier_lives) {
  std::set<std::uint32_t> nodes;
  for (const Order& order : of_this_life) {
    const bool undone =
        std::any_of(of_earlier_lives.begin(), of_earlier_lives.end(), [&](const Order& earlier) {
          return compete(order, earlier) && earlier.revision >= order.revision;
        });
    if (undone) nodes.insert(order.node);
  }
  std::vector<Order> again;
  for (const Order& order : of_this_life) {
    if (nodes.contains(order.node)) again.push_back(order);
  }
  std::stable_sort(again.begin(), again.end(),
                   [](const Order& a, const Order& b) { return a.revision < b.revision; });
  return again;
}

}  // namespace warren
