// SPDX-License-Identifier: Apache-2.0
#include "tools/world/floor_graph.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tools/world/floor_raster.hpp"
#include "tools/world/node_grid.hpp"

namespace warren::world {
namespace {

// Widest places first, none too near to one before it.
void choose_nodes(PassageGraph& graph, const FloorRaster& raster, const FloorGraph& settings) {
  std::vector<std::tuple<double, int, int>> cells;
  for (int y = 0; y < raster.height(); ++y)
    for (int x = 0; x < raster.width(); ++x)
      if (raster.clearance_m(x, y) >= settings.half_width_m)
        cells.emplace_back(-raster.clearance_m(x, y), y, x);
  std::sort(cells.begin(), cells.end());
  NodeGrid grid(graph);
  for (const auto& [negative_m, y, x] : cells) {
    const Eigen::Vector3d place = raster.position(x, y);
    if (!grid.within(place, settings.node_every_m).empty()) continue;
    graph.add_node({place, -negative_m});
    grid.update();
  }
}

// Whether the straight way keeps to the floor, with room to both sides.
bool is_free(const FloorRaster& raster, const FloorGraph& settings, const Eigen::Vector3d& from,
             const Eigen::Vector3d& to) {
  const int probes = static_cast<int>(std::ceil((to - from).norm() / (0.5 * settings.cell_m)));
  for (int i = 0; i <= probes; ++i) {
    const Eigen::Vector3d probe = from + (to - from) * i / probes;
    const auto z = raster.floor_z(probe);
    if (!z || std::abs(*z - probe.z()) > settings.step_m) return false;
    if (raster.clearance_m(probe) < 0.75 * settings.half_width_m) return false;
  }
  return true;
}

// Shortest first; none that a third node's two shorter edges make needless.
void add_edges(PassageGraph& graph, const FloorRaster& raster, const FloorGraph& settings) {
  const NodeGrid grid(graph);
  std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t a = 0; a < graph.nodes.size(); ++a) {
    const Eigen::Vector3d& from = graph.nodes[a].position;
    for (const std::uint32_t b : grid.within(from, 2.0 * settings.node_every_m))
      if (b > a && is_free(raster, settings, from, graph.nodes[b].position))
        pairs.emplace_back((graph.nodes[b].position - from).norm(), a, b);
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::vector<std::uint32_t>> near(graph.nodes.size());
  for (const auto& [length_m, a, b] : pairs) {
    const auto& of_b = near[b];
    const bool is_needless = std::any_of(near[a].begin(), near[a].end(), [&of_b](std::uint32_t c) {
      return std::find(of_b.begin(), of_b.end(), c) != of_b.end();
    });
    if (is_needless) continue;
    graph.add_edge(a, b);
    near[a].push_back(b);
    near[b].push_back(a);
  }
}

PassageGraph largest_part(const PassageGraph& graph) {
  const auto near = graph.neighbours(true);
  std::vector<std::uint32_t> part(graph.nodes.size(), 0);  // 0: not seen yet
  std::vector<std::size_t> sizes{0};
  for (std::uint32_t seed = 0; seed < graph.nodes.size(); ++seed) {
    if (part[seed] != 0) continue;
    const auto number = static_cast<std::uint32_t>(sizes.size());
    std::vector<std::uint32_t> open{seed};
    part[seed] = number;
    std::size_t size = 0;
    for (; size < open.size(); ++size)
      for (const std::uint32_t next : near[open[size]])
        if (part[next] == 0) {
          part[next] = number;
          open.push_back(next);
        }
    sizes.push_back(size);
  }
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  PassageGraph kept;
  std::vector<std::uint32_t> new_index(graph.nodes.size());
  for (std::uint32_t i = 0; i < graph.nodes.size(); ++i)
    if (part[i] == largest) new_index[i] = kept.add_node(graph.nodes[i]);
  for (const PassageGraph::Edge& edge : graph.edges)
    if (part[edge.from] == largest)
      kept.add_edge(new_index[edge.from], new_index[edge.to], edge.walkable);
  return kept;
}

}  // namespace

PassageGraph graph_of_floor(const TriangleMesh& mesh, const FloorGraph& settings) {
  const FloorRaster raster(
      mesh,
      {.cell_m = settings.cell_m, .headroom_m = settings.headroom_m, .step_m = settings.step_m});
  PassageGraph graph;
  choose_nodes(graph, raster, settings);
  add_edges(graph, raster, settings);
  return largest_part(graph);
}

}  // namespace warren::world
