// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <cmath>
#include <limits>
#include <set>

#include "tools/world/tile_graph.hpp"

namespace warren::world {
namespace {

constexpr auto kNone = std::numeric_limits<TileGraph::Tile>::max();

// Walks from node to node and gives each the tile of the one before, or a new one.
class Cutter {
 public:
  Cutter(const PassageGraph& graph, const TileCut& cut)
      : graph_(graph),
        cut_(cut),
        neighbours_(graph.neighbours(false)),
        tile_of_(graph.nodes.size(), kNone) {}

  void cut_all() {
    for (std::uint32_t node = 0; node < graph_.nodes.size(); ++node)
      if (tile_of_[node] == kNone) cut_from(node);
  }
  const std::vector<TileGraph::Tile>& tile_of() const { return tile_of_; }
  std::size_t tiles() const { return tiles_; }

 private:
  struct Visit {
    std::uint32_t node = 0;
    double length_m = 0.0;                              // since the tile began
    Eigen::Vector3d heading = Eigen::Vector3d::Zero();  // with which it began; zero: not known yet
  };

  bool is_junction(std::uint32_t node) const { return neighbours_[node].size() > 2; }

  void cut_from(std::uint32_t node) {
    std::vector<Visit> open{{.node = node}};
    tile_of_[node] = tiles_++;
    while (!open.empty()) {
      const Visit here = open.back();
      open.pop_back();
      for (const std::uint32_t next : neighbours_[here.node])
        if (tile_of_[next] == kNone) open.push_back(go_on(here, next));
    }
  }

  Visit go_on(const Visit& here, std::uint32_t next) {
    const Eigen::Vector3d way = graph_.nodes[next].position - graph_.nodes[here.node].position;
    const double length_m = here.length_m + way.norm();
    const bool has_turned =
        way.normalized().dot(here.heading) < std::cos(cut_.turn_rad) && !here.heading.isZero();
    const bool is_new =
        is_junction(here.node) || is_junction(next) || has_turned || length_m >= cut_.length_m;
    tile_of_[next] = is_new ? tiles_++ : tile_of_[here.node];
    if (is_new) return {next, 0.0, way.normalized()};
    return {next, length_m, here.heading.isZero() ? way.normalized() : here.heading};
  }

  const PassageGraph& graph_;
  const TileCut& cut_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::vector<TileGraph::Tile> tile_of_;
  TileGraph::Tile tiles_ = 0;
};

}  // namespace

RadioTiles passage_tiles(const PassageGraph& graph, const TileCut& cut) {
  Cutter cutter(graph, cut);
  cutter.cut_all();
  TileGraph tiles(cutter.tiles());
  std::set<std::pair<TileGraph::Tile, TileGraph::Tile>> joined;
  for (const PassageGraph::Edge& edge : graph.edges) {
    const TileGraph::Tile one = cutter.tile_of()[edge.from];
    const TileGraph::Tile other = cutter.tile_of()[edge.to];
    if (one != other && joined.insert(std::minmax(one, other)).second)
      tiles.add_edge(one, other, 1.0);
  }
  return {tiles, [graph, tile_of = cutter.tile_of()](const Eigen::Vector3d& position) {
            return graph.nodes.empty() ? std::nullopt
                                       : std::optional(tile_of[graph.nearest(position)]);
          }};
}

}  // namespace warren::world
