// SPDX-License-Identifier: Apache-2.0
#include "tools/world/node_grid.hpp"

#include <algorithm>
#include <cmath>

namespace warren::world {
namespace {

constexpr double kGridCell_m = 8.0;
constexpr double kSameStorey_m = 2.5;
constexpr double kLongestEdge_m = 8.0;

std::int32_t cell_of(double coordinate_m) {
  return static_cast<std::int32_t>(std::floor(coordinate_m / kGridCell_m));
}
std::uint64_t key_of(std::int32_t x, std::int32_t y) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
         static_cast<std::uint32_t>(y);
}

// Distance in plan from a point to a segment; infinite on another storey.
double distance_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector2d along = (b - a).head<2>();
  const double length2 = std::max(along.squaredNorm(), 1e-12);
  const double t = std::clamp((p - a).head<2>().dot(along) / length2, 0.0, 1.0);
  const Eigen::Vector3d away = p - (a + t * (b - a));
  return std::abs(away.z()) > kSameStorey_m ? HUGE_VAL : away.head<2>().norm();
}

}  // namespace

void NodeGrid::update() {
  edges_.resize(graph_->nodes.size());
  for (; known_nodes_ < graph_->nodes.size(); ++known_nodes_) {
    const Eigen::Vector3d& position = graph_->nodes[known_nodes_].position;
    cells_[key_of(cell_of(position.x()), cell_of(position.y()))].push_back(
        static_cast<std::uint32_t>(known_nodes_));
  }
  for (; known_edges_ < graph_->edges.size(); ++known_edges_) {
    const auto& edge = graph_->edges[known_edges_];
    edges_[edge.from].push_back(static_cast<std::uint32_t>(known_edges_));
    edges_[edge.to].push_back(static_cast<std::uint32_t>(known_edges_));
  }
}

std::vector<std::uint32_t> NodeGrid::within(const Eigen::Vector3d& position,
                                            double radius_m) const {
  std::vector<std::uint32_t> nodes;
  for (std::int32_t x = cell_of(position.x() - radius_m); x <= cell_of(position.x() + radius_m);
       ++x) {
    for (std::int32_t y = cell_of(position.y() - radius_m); y <= cell_of(position.y() + radius_m);
         ++y) {
      const auto cell = cells_.find(key_of(x, y));
      if (cell == cells_.end()) continue;
      for (const std::uint32_t node : cell->second)
        if ((graph_->nodes[node].position - position).head<2>().norm() <= radius_m)
          nodes.push_back(node);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

std::vector<std::uint32_t> NodeGrid::hops_from(std::uint32_t node, int hops) const {
  std::vector<std::uint32_t> reached{node};
  std::size_t done = 0;
  for (int hop = 0; hop < hops; ++hop) {
    for (const std::size_t ring_end = reached.size(); done < ring_end; ++done) {
      const std::uint32_t here = reached[done];
      for (const std::uint32_t edge : edges_[here]) {
        const std::uint32_t next = graph_->edges[edge].from ^ graph_->edges[edge].to ^ here;
        if (std::find(reached.begin(), reached.end(), next) == reached.end())
          reached.push_back(next);
      }
    }
  }
  std::sort(reached.begin(), reached.end());
  return reached;
}

double NodeGrid::to_path_m(const Eigen::Vector3d& position, double limit_m) const {
  double nearest_m = limit_m;
  for (const std::uint32_t node : within(position, limit_m + kLongestEdge_m / 2.0)) {
    for (const std::uint32_t edge : edges_[node]) {
      if (!graph_->edges[edge].walkable) continue;
      nearest_m =
          std::min(nearest_m, distance_m(position, graph_->nodes[graph_->edges[edge].from].position,
                                         graph_->nodes[graph_->edges[edge].to].position));
    }
  }
  return nearest_m;
}

}  // namespace warren::world
