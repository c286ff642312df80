// SPDX-License-Identifier: Apache-2.0
#include "tools/world/network.hpp"

#include <cmath>

namespace warren::world {
namespace {

constexpr double kNodeEvery_m = 2.0;

}  // namespace

std::uint32_t Network::add_node(const PassageGraph::Node& node, double passage_height_m) {
  height_m.push_back(passage_height_m);
  return graph.add_node(node);
}

void Network::add_passage(std::uint32_t from, std::uint32_t to, bool walkable) {
  graph.add_edge(from, to, walkable);
  const auto end = [this](std::uint32_t node) {
    return Passage::End{graph.nodes[node].position, graph.nodes[node].half_width_m, height_m[node]};
  };
  passages.push_back({end(from), end(to)});
}

std::uint32_t Network::add_way(std::uint32_t from, const PassageGraph::Node& to,
                               double passage_height_m, Air air) {
  const std::uint32_t last = add_node(to, passage_height_m);
  join(from, last, air);
  return last;
}

void Network::join(std::uint32_t from, std::uint32_t to, Air air) {
  const PassageGraph::Node a = graph.nodes[from];
  const PassageGraph::Node b = graph.nodes[to];
  const double a_height_m = height_m[from];
  const double b_height_m = height_m[to];
  const int pieces =
      static_cast<int>(std::ceil((b.position - a.position).norm() / kNodeEvery_m - 1e-6));
  std::uint32_t last = from;
  for (int i = 1; i <= pieces; ++i) {
    const double t = static_cast<double>(i) / pieces;
    const std::uint32_t next =
        i == pieces ? to
                    : add_node({a.position + t * (b.position - a.position),
                                a.half_width_m + t * (b.half_width_m - a.half_width_m)},
                               a_height_m + t * (b_height_m - a_height_m));
    air == Air::kAlong ? add_passage(last, next) : graph.add_edge(last, next);
    last = next;
  }
}

std::uint32_t Network::climb(std::uint32_t from, const Stairway& stairs, double half_width_m) {
  const double height = height_m[from];
  const std::uint32_t foot =
      add_way(from, {stairs.at(-stairs.run_m, 0.0, 0.0), half_width_m}, height, Air::kNone);
  return add_way(foot, {stairs.top(), half_width_m}, height, Air::kNone);
}

}  // namespace warren::world
