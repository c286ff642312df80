// SPDX-License-Identifier: Apache-2.0
#include "tools/world/route.hpp"

#include <algorithm>
#include <set>

namespace warren::world {
namespace {

using Neighbours = std::vector<std::vector<std::uint32_t>>;

void shuffle(std::vector<std::uint32_t>& items, Random& random) {
  for (std::size_t left = items.size(); left > 1; --left)
    std::swap(items[left - 1], items[random.below(static_cast<std::uint32_t>(left))]);
}

// Depth first without recursion: a long gallery has thousands of nodes.
class DepthFirst {
 public:
  DepthFirst(Neighbours neighbours, std::uint32_t start)
      : neighbours_(std::move(neighbours)),
        next_(neighbours_.size(), 0),
        is_visited_(neighbours_.size(), false) {
    enter(start);
  }

  std::vector<std::uint32_t> walk() {
    while (!way_in_.empty()) step();
    return std::move(walked_);
  }

 private:
  void enter(std::uint32_t node) {
    is_visited_[node] = true;
    way_in_.push_back(node);
    walked_.push_back(node);
  }
  void step() {
    const std::uint32_t node = way_in_.back();
    if (next_[node] == neighbours_[node].size()) return leave();
    const std::uint32_t other = neighbours_[node][next_[node]++];
    if (!used_.insert(std::minmax(node, other)).second) return;
    if (!is_visited_[other]) return enter(other);
    walked_.push_back(other);  // closes a loop: look, and come back
    walked_.push_back(node);
  }
  void leave() {
    way_in_.pop_back();
    if (!way_in_.empty()) walked_.push_back(way_in_.back());
  }

  Neighbours neighbours_;
  std::vector<std::size_t> next_;
  std::vector<bool> is_visited_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> used_;  // edges
  std::vector<std::uint32_t> way_in_;
  std::vector<std::uint32_t> walked_;
};

Route positions_of(const PassageGraph& graph, const std::vector<std::uint32_t>& nodes) {
  Route route;
  for (const std::uint32_t node : nodes) route.push_back(graph.nodes[node].position);
  return route;
}

}  // namespace

double length_of(const Route& route) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) length_m += (route[i] - route[i - 1]).norm();
  return length_m;
}

Route explore(const PassageGraph& graph, std::uint32_t start, Random random) {
  Neighbours neighbours = graph.neighbours(true);
  for (auto& of_one : neighbours) shuffle(of_one, random);
  return positions_of(graph, DepthFirst(std::move(neighbours), start).walk());
}

Route route_through(const PassageGraph& graph, std::span<const Eigen::Vector3d> way_points) {
  std::vector<std::uint32_t> nodes;
  for (const Eigen::Vector3d& way_point : way_points) {
    const std::uint32_t goal = graph.nearest(way_point);
    if (nodes.empty()) {
      nodes.push_back(goal);
      continue;
    }
    const auto path = graph.shortest_path(nodes.back(), goal);
    if (!path.empty()) nodes.insert(nodes.end(), path.begin() + 1, path.end());
  }
  return positions_of(graph, nodes);
}

}  // namespace warren::world
