// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/layer/replica.hpp"

namespace warren {

// Every region that goes first cuts the packets of the sweep at its ends: so they are few, and few
// of those that changed.
inline constexpr std::size_t kHotRegionsMax = 16;
inline constexpr std::size_t kChangedPerHotRegion = 8;

// The intervals of keys that a sender tells in turn to who holds `from`: the hot regions, changed
// last, latest first, then all keys in order. Hot regions between which nothing changed are one
// interval, which stands where the later changed of them would.
std::vector<KeyInterval> catch_up_parts(const Replica& sender, Revision from);

}  // namespace warren
