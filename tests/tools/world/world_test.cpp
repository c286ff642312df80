// SPDX-License-Identifier: Apache-2.0
#include "tools/world/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <doctest/doctest.h>

#include "tests/support/recorded_data.hpp"
#include "tests/tools/world/mesh_measures.hpp"
#include "tests/tools/world/ray_grid.hpp"

namespace warren::world {
namespace {

const std::vector<std::string> kGenerated = {"cave", "tunnel", "urban", "mine", "room"};
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

World made(const std::string& preset, std::uint64_t seed, double length_m = 0.0) {
  auto world = make_world({preset, seed, length_m});
  REQUIRE_MESSAGE(world.has_value(), world.error());
  return std::move(*world);
}

void check_floor_below_nodes(const World& world, const test::RayGrid& rays) {
  for (const PassageGraph::Node& node : world.passages.nodes) {
    const auto below_m = rays.down(node.position + 0.5 * kUp, 1.5);
    CAPTURE(node.position.transpose());
    REQUIRE(below_m.has_value());
    CHECK(std::abs(*below_m - 0.5) < 0.3);
  }
}

void check_edges_are_free(const World& world, const test::RayGrid& rays) {
  for (const PassageGraph::Edge& edge : world.passages.edges) {
    if (!edge.walkable) continue;
    const Eigen::Vector3d& from = world.passages.nodes[edge.from].position;
    const Eigen::Vector3d& to = world.passages.nodes[edge.to].position;
    CAPTURE(from.transpose());
    CAPTURE(to.transpose());
    CHECK((to - from).norm() < 2.6);
    const Eigen::Vector3d left = 0.25 * kUp.cross(to - from).normalized();
    for (const double aside : {-1.0, 0.0, 1.0})
      CHECK_FALSE(rays.first_hit(from + aside * left + 0.5 * kUp, to + aside * left + 0.5 * kUp));
    // And there is ground all the way.
    for (int eighth = 0; eighth < 8; ++eighth) {
      const double t = 0.125 * eighth;
      const auto below_m = rays.down(from + t * (to - from) + 0.5 * kUp, 1.5);
      REQUIRE(below_m.has_value());
      CHECK(std::abs(*below_m - 0.5) < 0.35);
    }
  }
}

// Nodes that can be walked to from a node.
std::size_t reachable(const PassageGraph& graph, std::uint32_t from) {
  const auto near = graph.neighbours(true);
  std::set<std::uint32_t> seen{from};
  std::vector<std::uint32_t> open{from};
  while (!open.empty()) {
    const std::uint32_t here = open.back();
    open.pop_back();
    for (const std::uint32_t next : near[here])
      if (seen.insert(next).second) open.push_back(next);
  }
  return seen.size();
}

std::map<Surface, int> count_surfaces(const TriangleMesh& mesh) {
  std::map<Surface, int> count;
  for (const Surface surface : mesh.surfaces) ++count[surface];
  return count;
}

}  // namespace

TEST_CASE("the same spec gives the same world to the last byte, another seed another") {
  for (const std::string& preset : kGenerated) {
    CAPTURE(preset);
    const World world = made(preset, 3);
    const World again = made(preset, 3);
    CHECK(world.name == preset);
    CHECK(world.seed == 3);
    CHECK(test::is_same(world.mesh, again.mesh));
    REQUIRE(world.passages.nodes.size() == again.passages.nodes.size());
    for (std::size_t i = 0; i < world.passages.nodes.size(); ++i)
      CHECK(world.passages.nodes[i].position == again.passages.nodes[i].position);
    CHECK_FALSE(test::is_same(world.mesh, made(preset, 4).mesh));
  }
}

TEST_CASE("every passage has floor below it and no obstacle in its way") {
  for (const std::string& preset : kGenerated) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      CAPTURE(preset);
      CAPTURE(seed);
      const World world = made(preset, seed);
      const test::RayGrid rays(world.mesh);
      check_floor_below_nodes(world, rays);
      check_edges_are_free(world, rays);
    }
  }
}

TEST_CASE("nearly all of a world can be walked to from its start") {
  for (const std::string& preset : kGenerated) {
    CAPTURE(preset);
    const World world = made(preset, 5);
    const std::uint32_t start = world.passages.nearest(world.start);
    CHECK((world.passages.nodes[start].position - world.start).norm() < 0.1);
    CHECK(10 * reachable(world.passages, start) > 9 * world.passages.nodes.size());
  }
}

TEST_CASE("the passages are as long as was asked for") {
  for (const std::string preset : {"cave", "tunnel", "urban", "mine"}) {
    CAPTURE(preset);
    for (const double length_m : {300.0, 700.0})
      CHECK(made(preset, 2, length_m).passages.length_m() ==
            doctest::Approx(length_m).epsilon(0.15));
  }
  CHECK(made("room", 2, 60.0).passages.length_m() > made("room", 2).passages.length_m());
}

TEST_CASE("rock is closed around all air") {
  for (const std::string preset : {"cave", "tunnel", "mine"}) {
    for (const std::uint64_t seed : {1U, 6U}) {
      CAPTURE(preset);
      CAPTURE(seed);
      const World world = made(preset, seed);
      TriangleMesh rock = world.mesh;
      rock.triangles.clear();
      for (std::size_t i = 0; i < world.mesh.triangles.size(); ++i)
        if (world.mesh.surfaces[i] <= Surface::kFloor)
          rock.triangles.push_back(world.mesh.triangles[i]);
      CHECK(test::is_closed(rock));
      CHECK(test::volume_m3(rock) < 0.0);
    }
  }
}

TEST_CASE("the edges of stairways are vertices of the mesh, and their ends are on passages") {
  for (const std::string preset : {"urban", "mine", "room"}) {
    CAPTURE(preset);
    const World world = made(preset, 8);
    REQUIRE_FALSE(world.stairways.empty());
    std::set<std::array<float, 3>> places;
    for (std::size_t i = 0; i < world.mesh.triangles.size(); ++i)
      if (world.mesh.surfaces[i] == Surface::kStairs)
        for (const std::uint32_t vertex : world.mesh.triangles[i]) {
          const Eigen::Vector3f& v = world.mesh.vertices[vertex];
          places.insert({v.x(), v.y(), v.z()});
        }
    const auto is_vertex = [&places](const Eigen::Vector3d& p) {
      const Eigen::Vector3f v = p.cast<float>();
      return places.contains({v.x(), v.y(), v.z()});
    };
    for (const Stairway& stairs : world.stairways) {
      for (const Stairway::Edge& edge : stairs.edges()) {
        CHECK(is_vertex(edge.left));
        CHECK(is_vertex(edge.right));
      }
      const std::uint32_t low = world.passages.nearest(stairs.at(-stairs.run_m, 0.0, 0.0));
      const std::uint32_t high = world.passages.nearest(stairs.top());
      CHECK((world.passages.nodes[high].position - stairs.top()).norm() < 1e-6);
      CHECK(world.passages.shortest_path(low, high).size() < 12);
    }
  }
}

TEST_CASE("every world holds the things that it is known for") {
  const auto cave = count_surfaces(made("cave", 1).mesh);
  CHECK(cave.contains(Surface::kBoulder));
  CHECK(cave.contains(Surface::kRubble));
  const auto tunnel = count_surfaces(made("tunnel", 1).mesh);
  for (const Surface surface : {Surface::kRail, Surface::kCable, Surface::kFence})
    CHECK(tunnel.contains(surface));
  const auto urban = count_surfaces(made("urban", 1).mesh);
  for (const Surface surface : {Surface::kWall, Surface::kCeiling, Surface::kStairs, Surface::kRamp,
                                Surface::kStepfield, Surface::kCable})
    CHECK(urban.contains(surface));
  const auto mine = count_surfaces(made("mine", 1).mesh);
  for (const Surface surface : {Surface::kRail, Surface::kStairs, Surface::kCable, Surface::kFence})
    CHECK(mine.contains(surface));
}

TEST_CASE("caves have pits that nobody can walk into, and slopes that stay below 30 degrees") {
  const World cave = made("cave", 1, 400.0);
  int pits = 0;
  for (const PassageGraph::Edge& edge : cave.passages.edges) {
    const Eigen::Vector3d way =
        cave.passages.nodes[edge.to].position - cave.passages.nodes[edge.from].position;
    if (!edge.walkable) ++pits;
    if (edge.walkable) CHECK(std::abs(way.z()) <= 0.5774 * way.head<2>().norm() + 1e-9);
  }
  CHECK(pits > 0);
}

TEST_CASE("the names of the presets make worlds, and any other name lists them") {
  const auto names = preset_names();
  for (const std::string& preset : kGenerated)
    CHECK(std::count(names.begin(), names.end(), preset) == 1);
  const auto none = make_world({"attic", 1, 0.0});
  REQUIRE_FALSE(none.has_value());
  CHECK(none.error().find("attic") != std::string::npos);
  CHECK(none.error().find("cave, tunnel, urban, mine, room") != std::string::npos);
}

TEST_CASE("the Edgar mine's passages are kilometres on its floor") {
  const auto file = test::recorded_file("meshes/edgar_mine.dae");
  if (!file) return;
  const World world = made("edgar", 1);
  const test::RayGrid rays(world.mesh);
  CHECK(world.passages.length_m() > 2000.0);
  check_floor_below_nodes(world, rays);
  CHECK(reachable(world.passages, 0) == world.passages.nodes.size());
}

}  // namespace warren::world
