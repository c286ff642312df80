// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace warren {

// The number of a node, made of its name: equal names, equal numbers. Unequal ones may share a
// number by chance (of 100 nodes, once in a million fleets).
std::uint32_t node_id(const std::string& name);

}  // namespace warren
