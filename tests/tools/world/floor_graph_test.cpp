// SPDX-License-Identifier: Apache-2.0
#include "tools/world/floor_graph.hpp"

#include <doctest/doctest.h>

#include "tools/world/floor_plan.hpp"

namespace warren::world {
namespace {

Eigen::AlignedBox3d air(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return {low, high};
}

}  // namespace

TEST_CASE("the graph of two rooms leads through the door between them, on the floor") {
  FloorPlan plan({Eigen::Vector2d(0, 0), Eigen::Vector2d(20, 10)}, 0.25);
  plan.carve(air({1, 1, 0.5}, {9, 9, 3}));
  plan.carve(air({10, 1, 0.5}, {18, 9, 3}));
  plan.carve(air({9, 4, 0.5}, {10, 6, 3}));
  const PassageGraph graph = graph_of_floor(plan.mesh());
  const auto path = graph.shortest_path(graph.nearest({2, 2, 0.5}), graph.nearest({17, 8, 0.5}));
  REQUIRE(path.size() > 5);
  for (const std::uint32_t node : path)
    CHECK(graph.nodes[node].position.z() == doctest::Approx(0.5));
}

TEST_CASE("no edge leads over a step that is too high or through a room without headroom") {
  FloorPlan plan({Eigen::Vector2d(0, 0), Eigen::Vector2d(20, 10)}, 0.25);
  plan.carve(air({1, 1, 0}, {9, 9, 3}));
  plan.carve(air({9, 1, 0.5}, {12, 9, 3}));
  plan.carve(air({12, 1, 0.5}, {18, 9, 1.5}));
  for (const PassageGraph::Node& node : graph_of_floor(plan.mesh()).nodes) {
    CHECK(node.position.x() < 9.0);
    CHECK(node.position.z() == doctest::Approx(0.0));
  }
}

}  // namespace warren::world
