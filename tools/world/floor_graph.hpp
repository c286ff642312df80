// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/world/passage_graph.hpp"
#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

struct FloorGraph {
  double cell_m = 0.25;
  double headroom_m = 1.4;
  double step_m = 0.2;        // from cell to cell
  double half_width_m = 0.6;  // of the free floor around a node
  double node_every_m = 2.0;
};
// A passage graph found from a mesh alone, of one storey: the lowest floor with headroom in each
// cell, nodes where there is most room, edges where the straight way between is free. Only the
// largest connected part.
PassageGraph graph_of_floor(const TriangleMesh& mesh, const FloorGraph& settings = {});

}  // namespace warren::world
