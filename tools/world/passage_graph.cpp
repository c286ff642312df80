// SPDX-License-Identifier: Apache-2.0
#include "tools/world/passage_graph.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <queue>

namespace warren::world {
namespace {

constexpr auto kNoNode = std::numeric_limits<std::uint32_t>::max();
using Predecessors = std::vector<std::uint32_t>;

// Dijkstra (1959) from one node, until `to` is settled. Ties go to the lower index.
Predecessors settle_until(const PassageGraph& graph, std::uint32_t from, std::uint32_t to) {
  struct Open {
    double length_m;
    std::uint32_t node;
    auto operator<=>(const Open&) const = default;
  };
  const auto near = graph.neighbours(true);
  std::vector<double> length_m(graph.nodes.size(), std::numeric_limits<double>::infinity());
  Predecessors before(graph.nodes.size(), kNoNode);
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  length_m[from] = 0.0;
  open.push({0.0, from});
  while (!open.empty() && open.top().node != to) {
    const Open here = open.top();
    open.pop();
    if (here.length_m > length_m[here.node]) continue;
    for (const std::uint32_t next : near[here.node]) {
      const double there =
          here.length_m + (graph.nodes[next].position - graph.nodes[here.node].position).norm();
      if (there >= length_m[next]) continue;
      length_m[next] = there;
      before[next] = here.node;
      open.push({there, next});
    }
  }
  return before;
}

}  // namespace

std::uint32_t PassageGraph::add_node(const Node& node) {
  nodes.push_back(node);
  return static_cast<std::uint32_t>(nodes.size() - 1);
}

void PassageGraph::add_edge(std::uint32_t from, std::uint32_t to, bool walkable) {
  assert(from < nodes.size() && to < nodes.size() && from != to);
  edges.push_back({from, to, walkable});
}

std::vector<std::vector<std::uint32_t>> PassageGraph::neighbours(bool walkable_only) const {
  std::vector<std::vector<std::uint32_t>> near(nodes.size());
  for (const Edge& edge : edges) {
    if (walkable_only && !edge.walkable) continue;
    near[edge.from].push_back(edge.to);
    near[edge.to].push_back(edge.from);
  }
  return near;
}

std::uint32_t PassageGraph::nearest(const Eigen::Vector3d& position) const {
  assert(!nodes.empty());
  const auto nearer = [&position](const Node& a, const Node& b) {
    return (a.position - position).squaredNorm() < (b.position - position).squaredNorm();
  };
  const auto best = std::min_element(nodes.begin(), nodes.end(), nearer);
  return static_cast<std::uint32_t>(best - nodes.begin());
}

std::vector<std::uint32_t> PassageGraph::shortest_path(std::uint32_t from, std::uint32_t to) const {
  assert(from < nodes.size() && to < nodes.size());
  if (from == to) return {from};
  const Predecessors before = settle_until(*this, from, to);
  if (before[to] == kNoNode) return {};
  std::vector<std::uint32_t> path{to};
  while (path.back() != from) path.push_back(before[path.back()]);
  std::reverse(path.begin(), path.end());
  return path;
}

double PassageGraph::length_m() const {
  double sum = 0.0;
  for (const Edge& edge : edges)
    sum += (nodes[edge.from].position - nodes[edge.to].position).norm();
  return sum;
}

}  // namespace warren::world
