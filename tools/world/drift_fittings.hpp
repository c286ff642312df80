// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/world/network.hpp"
#include "tools/world/random.hpp"
#include "tools/world/world.hpp"

namespace warren::world {

using Way = std::vector<std::uint32_t>;  // nodes, one after the other

// The shortest way to that of the targets which is farthest as the crow flies.
Way way_to_farthest(const PassageGraph& graph, std::uint32_t from,
                    const std::vector<std::uint32_t>& targets);

void lay_rails(World& world, const Way& way);
// Cables from hook to hook under the roof, along the left wall.
void hang_cables(World& world, const Network& network, const Way& way);
// Torn cables that hang down beside the middle, and some across from wall to wall above head
// height.
void dangle_cables(World& world, const Network& network, double share, Random& random);
// Closes some dead ends, at least one if there is any, with wire netting; the edge behind it
// becomes impassable. Node 0 stays open.
void fence_dead_ends(World& world, const Network& network, double share, Random& random);

}  // namespace warren::world
