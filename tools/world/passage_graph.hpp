// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace warren::world {

// The middle lines of a world's passages, on the floor: routes follow them, radio is computed on
// them. Nodes about 2 m apart; every edge can be walked in a straight line unless `walkable` is
// false (a shaft, a drop).
struct PassageGraph {
  struct Node {
    Eigen::Vector3d position;  // on the floor, metres
    double half_width_m = 1.5;
  };
  struct Edge {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool walkable = true;
  };
  std::vector<Node> nodes;
  std::vector<Edge> edges;  // undirected

  std::uint32_t add_node(const Node& node);
  void add_edge(std::uint32_t from, std::uint32_t to, bool walkable = true);
  std::vector<std::vector<std::uint32_t>> neighbours(bool walkable_only) const;
  // Index of the node nearest to a position; the graph must not be empty.
  std::uint32_t nearest(const Eigen::Vector3d& position) const;
  // Nodes along the shortest walkable way, both ends included; empty if there is none.
  std::vector<std::uint32_t> shortest_path(std::uint32_t from, std::uint32_t to) const;
  // Sum of the lengths of all edges, metres.
  double length_m() const;
};

}  // namespace warren::world
