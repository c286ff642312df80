// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "tools/world/passage_graph.hpp"

namespace warren::world {

// A world cut into tiles, with what radio pays to get from one to its neighbour.
class TileGraph {
 public:
  using Tile = std::uint32_t;

  explicit TileGraph(std::size_t tiles) : neighbours_(tiles) {}

  std::size_t size() const { return neighbours_.size(); }
  void add_edge(Tile one, Tile other, double cost);
  // Along the cheapest way to every tile; infinity where there is none.
  std::vector<double> costs_from(Tile tile) const;

 private:
  struct Neighbour {
    Tile tile;
    double cost;
  };
  std::vector<std::vector<Neighbour>> neighbours_;
};

// Costs between places. Immutable; a thousand tiles take 8 MB.
class RadioTiles {
 public:
  using TileAt = std::function<std::optional<TileGraph::Tile>(const Eigen::Vector3d&)>;
  RadioTiles(const TileGraph& graph, TileAt tile_at);

  std::size_t size() const { return costs_.size(); }
  std::optional<TileGraph::Tile> tile_at(const Eigen::Vector3d& position) const {
    return tile_at_(position);
  }
  // Infinity outside all tiles and where no way leads.
  double cost(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

 private:
  std::vector<std::vector<double>> costs_;
  TileAt tile_at_;
};

// Cuts passages as the SubT tiles are cut: a tile ends after `length_m`, where the passage has
// turned by `turn_rad` since the tile began, and at every junction, which is a tile of its own. To
// cross from one to the next costs 1. So a straight gallery loses sight after 200 m, a winding one
// sooner.
struct TileCut {
  double length_m = 20.0;
  double turn_rad = 0.785;
};
RadioTiles passage_tiles(const PassageGraph& graph, const TileCut& cut = {});

}  // namespace warren::world
