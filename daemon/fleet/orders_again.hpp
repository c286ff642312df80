// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "daemon/fleet/order.hpp"

namespace warren {

// A base that lost its disk numbers its orders from 1 again, while others still have those of its
// earlier life, with higher revisions. Of the orders of this life these have to be given again,
// above all others: the ones on every node on which an earlier order would undo one of them. In the
// order in which they were given.
std::vector<Order> orders_to_give_again(const std::vector<Order>& of_this_life,
                                        const std::vector<Order>& of_earlier_lives);

}  // namespace warren
