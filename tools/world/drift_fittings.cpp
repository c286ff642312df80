// SPDX-License-Identifier: Apache-2.0
#include "tools/world/drift_fittings.hpp"

#include <algorithm>
#include <cmath>

#include "tools/world/cables.hpp"
#include "tools/world/rails.hpp"

namespace warren::world {
namespace {

constexpr double kBelowRoof_m = 0.35;

Eigen::Vector3d left_of(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d along = to - from;
  return Eigen::Vector3d(-along.y(), along.x(), 0.0).normalized();
}

Eigen::Vector3d up(double height_m) { return {0.0, 0.0, height_m}; }

}  // namespace

Way way_to_farthest(const PassageGraph& graph, std::uint32_t from,
                    const std::vector<std::uint32_t>& targets) {
  // As the crow flies is near enough, and one search instead of one for every target.
  const auto nearer = [&](std::uint32_t a, std::uint32_t b) {
    const Eigen::Vector3d& start = graph.nodes[from].position;
    return (graph.nodes[a].position - start).norm() < (graph.nodes[b].position - start).norm();
  };
  return graph.shortest_path(from, *std::max_element(targets.begin(), targets.end(), nearer));
}

void lay_rails(World& world, const Way& way) {
  std::vector<Eigen::Vector3d> line;
  for (const std::uint32_t node : way) line.push_back(world.passages.nodes[node].position);
  if (line.size() >= 2) world.mesh.append(rails(line, {}));
}

void hang_cables(World& world, const Network& network, const Way& way) {
  constexpr std::size_t kHookEvery = 3;  // nodes
  std::vector<Eigen::Vector3d> hooks;
  for (std::size_t i = 0; i + 1 < way.size(); i += kHookEvery) {
    const PassageGraph::Node& node = network.graph.nodes[way[i]];
    const Eigen::Vector3d left = left_of(node.position, network.graph.nodes[way[i + 1]].position);
    hooks.push_back(node.position + 0.75 * node.half_width_m * left +
                    up(network.height_m[way[i]] - kBelowRoof_m));
  }
  for (std::size_t i = 0; i + 1 < hooks.size(); ++i) {
    for (const double aside : {0.0, 0.12})
      world.mesh.append(cable({.from = hooks[i] + up(aside),
                               .to = hooks[i + 1] + up(aside),
                               .sag_m = 0.25 + aside,
                               .radius_m = 0.02}));
  }
}

void dangle_cables(World& world, const Network& network, double share, Random& random) {
  for (const PassageGraph::Edge& edge : network.graph.edges) {
    if (!random.chance(share)) continue;
    const PassageGraph::Node& node = network.graph.nodes[edge.from];
    const Eigen::Vector3d left = left_of(node.position, network.graph.nodes[edge.to].position);
    const double height_m = network.height_m[edge.from];
    const Eigen::Vector3d roof = node.position + up(height_m + 0.1);
    if (random.chance(0.5)) {
      const double aside = random.chance(0.5) ? 0.6 : -0.6;
      const Eigen::Vector3d top = roof + aside * node.half_width_m * left;
      const double end_m = random.uniform(0.5, 1.6);
      world.mesh.append(
          cable({.from = top, .to = top - up(height_m - end_m), .sag_m = 0.0, .radius_m = 0.015}));
    } else {
      const Eigen::Vector3d hook = roof - up(kBelowRoof_m + 0.1);
      const Eigen::Vector3d aside = (node.half_width_m + 0.1) * left;
      world.mesh.append(cable({.from = hook - aside,
                               .to = hook + aside,
                               .sag_m = random.uniform(0.1, 0.4),
                               .radius_m = 0.015}));
    }
  }
}

void fence_dead_ends(World& world, const Network& network, double share, Random& random) {
  std::vector<int> degree(world.passages.nodes.size(), 0);
  for (const PassageGraph::Edge& edge : world.passages.edges) {
    ++degree[edge.from];
    ++degree[edge.to];
  }
  bool is_first = true;
  for (PassageGraph::Edge& edge : world.passages.edges) {
    const std::uint32_t end = degree[edge.to] == 1 ? edge.to : edge.from;
    if (degree[end] != 1 || end == 0) continue;
    if (!is_first && !random.chance(share)) continue;
    is_first = false;
    edge.walkable = false;
    const PassageGraph::Node& node = world.passages.nodes[end];
    const Eigen::Vector3d& other = world.passages.nodes[edge.from ^ edge.to ^ end].position;
    const Eigen::Vector3d middle = (node.position + other) / 2.0;
    const Eigen::Vector3d aside = (node.half_width_m + 0.1) * left_of(other, node.position);
    world.mesh.append(fence(
        {.from = middle - aside, .to = middle + aside, .height_m = network.height_m[end] - 0.3}));
  }
}

}  // namespace warren::world
