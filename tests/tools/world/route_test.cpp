// SPDX-License-Identifier: Apache-2.0
#include "tools/world/route.hpp"

#include <algorithm>
#include <set>

#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"
#include "tools/world/placement.hpp"
#include "tools/world/wall_following.hpp"

using namespace warren::world;

namespace {

// A grid of galleries, 3 x 3, 4 m apart: it has loops. One edge is a shaft, one node beyond it.
PassageGraph galleries() {
  PassageGraph graph;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      graph.add_node({Eigen::Vector3d(4.0 * column, 4.0 * row, 0.0)});
  for (std::uint32_t i = 0; i < 9; ++i) {
    if (i % 3 < 2) graph.add_edge(i, i + 1);
    if (i < 6) graph.add_edge(i, i + 3);
  }
  graph.add_edge(8, graph.add_node({Eigen::Vector3d(8.0, 8.0, -5.0)}), false);
  return graph;
}

using Leg = std::pair<std::uint32_t, std::uint32_t>;
std::set<Leg> legs_of(const PassageGraph& graph, const Route& route) {
  std::set<Leg> legs;
  for (std::size_t i = 1; i < route.size(); ++i)
    legs.insert(std::minmax(graph.nearest(route[i - 1]), graph.nearest(route[i])));
  return legs;
}

}  // namespace

TEST_CASE("exploring goes along every walkable edge, along nothing else, and comes back") {
  const PassageGraph graph = galleries();
  std::set<Leg> walkable;
  for (const auto& edge : graph.edges)
    if (edge.walkable) walkable.insert(std::minmax(edge.from, edge.to));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Route route = explore(graph, 4, Random(seed));
    CHECK(legs_of(graph, route) == walkable);
    CHECK(route.front() == graph.nodes[4].position);
    CHECK(route.back() == graph.nodes[4].position);
    CHECK(length_of(route) == doctest::Approx(2.0 * 12 * 4.0));
  }
}

TEST_CASE("exploring by another seed goes another way") {
  const PassageGraph graph = galleries();
  CHECK(explore(graph, 0, Random(1)) == explore(graph, 0, Random(1)));
  std::set<double> second_x;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    second_x.insert(explore(graph, 0, Random(seed))[1].x());
  CHECK(second_x.size() == 2);
}

TEST_CASE("way-points are joined by shortest ways, and one out of reach is left out") {
  const PassageGraph graph = galleries();
  const std::array goals{Eigen::Vector3d(0.1, 0.2, 0.0), Eigen::Vector3d(8.0, 8.0, 0.1),
                         Eigen::Vector3d(8.0, 8.0, -5.0), Eigen::Vector3d(8.0, 0.0, 0.0)};
  const Route route = route_through(graph, goals);
  CHECK(length_of(route) == doctest::Approx(16.0 + 8.0));
  CHECK(route.back() == graph.nodes[2].position);
}

TEST_CASE("following the wall leads round a room, at a distance, on ground that can be stood on") {
  const TriangleMesh mesh = test::room({6.0F, 4.0F, 1.5F});
  const Caster caster(mesh);
  const Route route = follow_wall(caster, husky(), {0.0, 0.0, -1.5}, 0.0);
  double reach_x = 0.0;
  double reach_y = 0.0;
  for (const Eigen::Vector3d& place : route) {
    reach_x = std::max(reach_x, std::abs(place.x()));
    reach_y = std::max(reach_y, std::abs(place.y()));
    CHECK(place.z() == doctest::Approx(-1.5));
  }
  CHECK(reach_x > 4.5);
  CHECK(reach_x < 5.6);
  CHECK(reach_y > 2.5);
  CHECK(reach_y < 3.6);
  CHECK(length_of(route) > 20.0);
}

TEST_CASE("following the wall stops where nothing is free") {
  const TriangleMesh mesh = test::room({0.5F, 0.4F, 0.5F});
  const Caster caster(mesh);
  CHECK(follow_wall(caster, husky(), {0.0, 0.0, -0.5}, 0.0).size() == 1);
}
