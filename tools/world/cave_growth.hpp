// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/world/network.hpp"
#include "tools/world/random.hpp"

namespace warren::world {

// Passages as water makes them: winding ways that branch, widen to chambers, meet again or end, no
// steeper than 30 degrees, with a pit beside the way in some chambers. Node 0 is the way in.
Network grow_cave(double length_m, Random random);

}  // namespace warren::world
