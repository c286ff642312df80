// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/world/boulders.hpp"
#include "tools/world/network.hpp"
#include "tools/world/presets.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

constexpr double kRoomLength_m = 16.0;
constexpr double kRoomHeight_m = 3.0;
constexpr double kPlatform_m = 0.9;  // how high, and how far from its wall

// Six walls seen from inside: a box turned inside out.
TriangleMesh hollow(const Eigen::AlignedBox3d& extent) {
  TriangleMesh mesh = box(extent, Surface::kWall);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle& triangle = mesh.triangles[i];
    std::swap(triangle[1], triangle[2]);
    const auto is_at = [&](double z) {
      return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t vertex) {
        return mesh.vertices[vertex].z() == static_cast<float>(z);
      });
    };
    if (is_at(extent.min().z())) mesh.surfaces[i] = Surface::kFloor;
    if (is_at(extent.max().z())) mesh.surfaces[i] = Surface::kCeiling;
  }
  return mesh;
}

// A platform along the far wall, with stairs up to it on the left and a ramp on the right.
void add_platform(World& world, double half_x, double half_y) {
  const Eigen::Vector3d corner(half_x - 1.5, -half_y, 0.0);
  world.mesh.append(box({corner, Eigen::Vector3d(half_x, half_y, kPlatform_m)}, Surface::kFloor));
  const Stairway stairs{.foot = {corner.x() - 5 * 0.28, 1.5, 0.0},
                        .yaw_rad = 0.0,
                        .steps = 5,
                        .rise_m = kPlatform_m / 5,
                        .run_m = 0.28,
                        .width_m = 1.2};
  world.mesh.append(solid_of(stairs));
  world.stairways.push_back(stairs);
  const Ramp ramp{
      .angle_rad = 20.0 * std::numbers::pi / 180.0, .height_m = kPlatform_m, .width_m = 1.2};
  world.mesh.append(wedge(ramp), upright({corner.x() - ramp.length_m(), -1.5, 0.0}, 0.0));
}

// Around the boulder: up the stairs, along the platform, down the ramp.
PassageGraph round_trip(double half_x, const Stairway& stairs) {
  Network ways;
  const auto node = [](double x, double y, double z) { return PassageGraph::Node{{x, y, z}, 0.6}; };
  const double ramp_m = kPlatform_m / std::tan(20.0 * std::numbers::pi / 180.0);
  const double edge_x = half_x - 1.5;
  const std::uint32_t first = ways.add_node(node(1.0 - half_x, -1.5, 0.0), kRoomHeight_m);
  std::uint32_t last = ways.add_way(first, node(1.0 - half_x, 1.5, 0.0), kRoomHeight_m);
  last = ways.add_way(last, node(stairs.foot.x() - stairs.run_m, 1.5, 0.0), kRoomHeight_m);
  last = ways.add_way(last, node(stairs.top().x(), 1.5, kPlatform_m), kRoomHeight_m);
  last = ways.add_way(last, node(edge_x + 0.75, 1.5, kPlatform_m), kRoomHeight_m);
  last = ways.add_way(last, node(edge_x + 0.75, -1.5, kPlatform_m), kRoomHeight_m);
  last = ways.add_way(last, node(edge_x, -1.5, kPlatform_m), kRoomHeight_m);
  last = ways.add_way(last, node(edge_x - ramp_m, -1.5, 0.0), kRoomHeight_m);
  ways.join(last, first);
  return ways.graph;
}

}  // namespace

World make_room(const WorldSpec& spec) {
  Random random(spec.seed);
  const double length_m = spec.length_m > 0.0 ? spec.length_m : kRoomLength_m;
  const double half_x = std::max(4.0, length_m / 4.0);
  const double half_y = std::max(3.0, length_m / 6.0);
  World world;
  world.mesh = hollow(
      {Eigen::Vector3d(-half_x, -half_y, 0.0), Eigen::Vector3d(half_x, half_y, kRoomHeight_m)});
  add_platform(world, half_x, half_y);
  const Eigen::Vector3d place(random.uniform(-half_x + 2.4, half_x - 5.0),
                              random.uniform(-0.2, 0.2), 0.2);
  world.mesh.append(boulder({.radius_m = random.uniform(0.4, 0.6), .refinements = 3}, random),
                    upright(place, 0.0));
  world.passages = round_trip(half_x, world.stairways.front());
  world.start = world.passages.nodes[0].position;
  world.start_yaw_rad = 0.0;
  return world;
}

}  // namespace warren::world
