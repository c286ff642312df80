// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/world/passage_graph.hpp"
#include "tools/world/rock_field.hpp"
#include "tools/world/world.hpp"

namespace warren::world {

// Whether a way brings its own air, or leads through what is there.
enum class Air : std::uint8_t { kAlong, kNone };

// A graph of passages together with the air that belongs to it.
struct Network {
  PassageGraph graph;
  std::vector<double> height_m;  // by node
  std::vector<Passage> passages;
  std::vector<Shaft> shafts;

  std::uint32_t add_node(const PassageGraph::Node& node, double passage_height_m);
  // An edge and the air along it.
  void add_passage(std::uint32_t from, std::uint32_t to, bool walkable = true);
  // A straight way of edges not longer than about 2 m from a node to a new place; its last node.
  std::uint32_t add_way(std::uint32_t from, const PassageGraph::Node& to, double passage_height_m,
                        Air air = Air::kAlong);
  // The same between two nodes that exist.
  void join(std::uint32_t from, std::uint32_t to, Air air = Air::kAlong);
  // The way up a flight, over its nosings; from a node before its foot to a new one on its top.
  std::uint32_t climb(std::uint32_t from, const Stairway& stairs, double half_width_m);
};

}  // namespace warren::world
