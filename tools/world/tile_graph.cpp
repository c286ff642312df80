// SPDX-License-Identifier: Apache-2.0
#include "tools/world/tile_graph.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <queue>

namespace warren::world {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void TileGraph::add_edge(Tile one, Tile other, double cost) {
  assert(one < size() && other < size() && cost >= 0.0);
  neighbours_[one].push_back({other, cost});
  neighbours_[other].push_back({one, cost});
}

std::vector<double> TileGraph::costs_from(Tile tile) const {
  using Open = std::pair<double, Tile>;
  std::vector<double> costs(size(), kInfinity);
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  costs.at(tile) = 0.0;
  open.emplace(0.0, tile);
  while (!open.empty()) {
    const auto [cost, here] = open.top();
    open.pop();
    if (cost > costs[here]) continue;
    for (const Neighbour& next : neighbours_[here]) {
      if (cost + next.cost >= costs[next.tile]) continue;
      costs[next.tile] = cost + next.cost;
      open.emplace(costs[next.tile], next.tile);
    }
  }
  return costs;
}

RadioTiles::RadioTiles(const TileGraph& graph, TileAt tile_at) : tile_at_(std::move(tile_at)) {
  for (TileGraph::Tile tile = 0; tile < graph.size(); ++tile)
    costs_.push_back(graph.costs_from(tile));
}

double RadioTiles::cost(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  const auto first = tile_at_(from);
  const auto last = tile_at_(to);
  return first && last ? costs_.at(*first).at(*last) : kInfinity;
}

}  // namespace warren::world
