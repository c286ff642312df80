// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "tools/world/passage_graph.hpp"
#include "tools/world/random.hpp"

namespace warren::world {

// Places on the floor to go to one after the other in straight lines.
using Route = std::vector<Eigen::Vector3d>;
double length_of(const Route& route);

// Goes along every walkable edge that can be reached, depth first, and back to where it began. The
// random numbers pick which branch comes first.
Route explore(const PassageGraph& graph, std::uint32_t start, Random random);

// Along shortest ways from the node nearest to each way-point to the next one's; a way-point that
// cannot be reached is left out.
Route route_through(const PassageGraph& graph, std::span<const Eigen::Vector3d> way_points);

}  // namespace warren::world
