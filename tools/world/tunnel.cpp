// SPDX-License-Identifier: Apache-2.0
#include "tools/world/drift_fittings.hpp"
#include "tools/world/drift_lattice.hpp"
#include "tools/world/furnish.hpp"
#include "tools/world/presets.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

constexpr double kTunnelLength_m = 300.0;
constexpr double kWayIn_m = 12.0;
constexpr double kTunnelHalfWidth_m = 1.8;
constexpr double kTunnelHeight_m = 2.8;
constexpr double kTunnelMeshCell_m = 0.2;

struct Plan {
  Network network;
  std::vector<std::uint32_t> junctions;
};

// A way in from the west, and drifts on its far side.
Plan dig(double length_m, const Random& random) {
  Plan plan;
  const std::uint32_t door =
      plan.network.add_node({Eigen::Vector3d::Zero(), kTunnelHalfWidth_m}, kTunnelHeight_m);
  const std::uint32_t first =
      plan.network.add_way(door, {{kWayIn_m, 0.0, 0.0}, kTunnelHalfWidth_m}, kTunnelHeight_m);
  DriftLattice lattice{.length_m = length_m - kWayIn_m,
                       .half_width_m = kTunnelHalfWidth_m,
                       .height_m = kTunnelHeight_m};
  lattice.may_lie = [](const Eigen::Vector2i& place) { return place.x() >= 0; };
  plan.junctions = dig_lattice(plan.network, first, lattice, random);
  return plan;
}

}  // namespace

World make_tunnel(const WorldSpec& spec) {
  Random random(spec.seed);
  const Plan plan = dig(spec.length_m > 0.0 ? spec.length_m : kTunnelLength_m, random.fork(1));
  const RockField field({.section = Section::kDrift,
                         .wall_noise_m = 0.1,
                         .wall_wavelength_m = 1.5,
                         .floor_noise_m = 0.03,
                         .merge_m = 0.1,
                         .seed = random.fork(2).next()},
                        plan.network.passages);
  World world;
  world.mesh = mesh_of(field, kTunnelMeshCell_m);
  world.passages = plan.network.graph;
  world.start = world.passages.nodes[0].position;
  world.start_yaw_rad = heading_rad(world.start, world.passages.nodes[plan.junctions[0]].position);

  Random fitting_random = random.fork(3);
  const Way main_way = way_to_farthest(plan.network.graph, 0, plan.junctions);
  lay_rails(world, main_way);
  hang_cables(world, plan.network, main_way);
  dangle_cables(world, plan.network, 0.05, fitting_random);
  fence_dead_ends(world, plan.network, 0.3, fitting_random);
  scatter_litter(
      world, NodeGrid(world.passages),
      [&field](const Eigen::Vector3d& place) { return field.ground_z(place); },
      {.boulder_share = 0.03, .boulder_max_m = 0.5, .rubble_share = 0.06, .free_m = 0.6},
      fitting_random);
  return world;
}

}  // namespace warren::world
