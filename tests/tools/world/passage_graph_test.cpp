// SPDX-License-Identifier: Apache-2.0
#include "tools/world/passage_graph.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "tools/world/random.hpp"

namespace warren::world {
namespace {

PassageGraph random_graph(std::uint64_t seed) {
  Random random(seed);
  PassageGraph graph;
  for (int i = 0; i < 24; ++i)
    graph.add_node({{random.uniform(0, 9), random.uniform(0, 9), random.uniform(0, 3)}, 1.0});
  for (int i = 0; i < 34; ++i) {
    const std::uint32_t a = random.below(24);
    const std::uint32_t b = random.below(24);
    if (a != b) graph.add_edge(a, b, random.chance(0.8));
  }
  return graph;
}

double distance_m(const PassageGraph& graph, std::uint32_t a, std::uint32_t b) {
  return (graph.nodes[a].position - graph.nodes[b].position).norm();
}

// Floyd and Warshall's, as an oracle.
std::vector<std::vector<double>> all_distances(const PassageGraph& graph) {
  const std::size_t n = graph.nodes.size();
  std::vector<std::vector<double>> d(n, std::vector<double>(n, HUGE_VAL));
  for (std::size_t i = 0; i < n; ++i) d[i][i] = 0.0;
  for (const auto& edge : graph.edges)
    if (edge.walkable)
      d[edge.from][edge.to] = d[edge.to][edge.from] = distance_m(graph, edge.from, edge.to);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
  return d;
}

}  // namespace

TEST_CASE("shortest paths are as short as brute force finds them and lead along walkable edges") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PassageGraph graph = random_graph(seed);
    const auto distances = all_distances(graph);
    const auto near = graph.neighbours(true);
    for (std::uint32_t to = 1; to < 24; ++to) {
      const auto path = graph.shortest_path(0, to);
      if (std::isinf(distances[0][to])) {
        CHECK(path.empty());
        continue;
      }
      REQUIRE(path.front() == 0);
      REQUIRE(path.back() == to);
      double length_m = 0.0;
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        length_m += distance_m(graph, path[i], path[i + 1]);
        CHECK(std::count(near[path[i]].begin(), near[path[i]].end(), path[i + 1]) > 0);
      }
      CHECK(length_m == doctest::Approx(distances[0][to]));
    }
  }
}

TEST_CASE("a path from a node to itself is that node") {
  CHECK(random_graph(1).shortest_path(5, 5) == std::vector<std::uint32_t>{5});
}

TEST_CASE("the nearest node is the one that brute force finds") {
  const PassageGraph graph = random_graph(3);
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d place(random.uniform(-2, 11), random.uniform(-2, 11), 0.0);
    const std::uint32_t found = graph.nearest(place);
    for (const auto& node : graph.nodes)
      CHECK((graph.nodes[found].position - place).norm() <= (node.position - place).norm());
  }
}

TEST_CASE("impassable edges count as length but not as neighbours") {
  PassageGraph graph;
  graph.add_node({{0, 0, 0}, 1.0});
  graph.add_node({{3, 0, 4}, 1.0});
  graph.add_edge(0, 1, false);
  CHECK(graph.length_m() == doctest::Approx(5.0));
  CHECK(graph.neighbours(true)[0].empty());
  CHECK(graph.neighbours(false)[0].size() == 1);
  CHECK(graph.shortest_path(0, 1).empty());
}

}  // namespace warren::world
