// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "tools/world/passage_graph.hpp"

namespace warren::world {

// Finds the nodes and edges of a growing graph near a place, by a grid in plan.
class NodeGrid {
 public:
  explicit NodeGrid(const PassageGraph& graph) : graph_(&graph) { update(); }
  // Takes in what was added to the graph since.
  void update();
  // Nodes whose distance in plan is at most `radius_m`, by index.
  std::vector<std::uint32_t> within(const Eigen::Vector3d& position, double radius_m) const;
  const std::vector<std::uint32_t>& edges_of(std::uint32_t node) const { return edges_[node]; }
  // Nodes within so many edges of one, itself included, by index.
  std::vector<std::uint32_t> hops_from(std::uint32_t node, int hops) const;
  // Distance in plan to the nearest walkable edge at about this height (within 2.5 m); `limit_m` if
  // none is nearer.
  double to_path_m(const Eigen::Vector3d& position, double limit_m) const;

 private:
  const PassageGraph* graph_;
  std::size_t known_nodes_ = 0;
  std::size_t known_edges_ = 0;
  std::vector<std::vector<std::uint32_t>> edges_;  // by node
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace warren::world
