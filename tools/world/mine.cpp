// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>

#include "tools/world/drift_fittings.hpp"
#include "tools/world/drift_lattice.hpp"
#include "tools/world/furnish.hpp"
#include "tools/world/presets.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

constexpr double kMineLength_m = 400.0;
constexpr double kDepth_m = 10.8;  // of the lower level: three flights of twenty steps
constexpr double kMineHalfWidth_m = 2.4;
constexpr double kMineHeight_m = 3.6;
constexpr double kStairHalfWidth_m = 1.4;
constexpr double kMineMeshCell_m = 0.2;

struct Mine {
  Network network;
  std::vector<Stairway> stairways;
  std::vector<std::uint32_t> upper;  // junctions
  std::vector<std::uint32_t> lower;
};

PassageGraph::Node drift(double x, double y, double z) { return {{x, y, z}, kMineHalfWidth_m}; }

// A flight down a raise, as seen from its top; the air stays a little below the treads.
std::uint32_t descend(Mine& mine, std::uint32_t from, Random& random) {
  Network& network = mine.network;
  constexpr std::uint32_t kSteps = 20;
  const double run_m = random.uniform(0.26, 0.3);
  const Eigen::Vector3d top = network.graph.nodes[from].position;
  Stairway stairs{.foot = top - Eigen::Vector3d(0.0, (kSteps - 1) * run_m + 1.0, kDepth_m / 3.0),
                  .yaw_rad = std::numbers::pi / 2.0,
                  .steps = kSteps,
                  .rise_m = kDepth_m / 3.0 / kSteps,
                  .run_m = run_m,
                  .width_m = 2.0 * kStairHalfWidth_m - 0.3};
  mine.stairways.push_back(stairs);
  const PassageGraph::Node landing{stairs.at(-1.5, 0.0, 0.0), kStairHalfWidth_m};
  const std::uint32_t bottom = network.add_node(landing, kMineHeight_m);
  const std::uint32_t highest = network.climb(bottom, stairs, kStairHalfWidth_m);
  network.join(highest, from);
  const Eigen::Vector3d below(0.0, 0.0, -0.3);
  const auto end = [](const Eigen::Vector3d& floor) {
    return Passage::End{floor, kStairHalfWidth_m, kMineHeight_m};
  };
  network.passages.push_back({end(landing.position), end(stairs.foot)});
  network.passages.push_back({end(stairs.foot + below), end(stairs.top() + below), true});
  return bottom;
}

// Down to the lower level twice: a decline that a truck can take, and a raise with stairs.
std::uint32_t connect_levels(Mine& mine, std::uint32_t upper, Random& random) {
  Network& network = mine.network;
  std::uint32_t landing =
      network.add_way(upper, {{0.0, -4.0, 0.0}, kStairHalfWidth_m}, kMineHeight_m);
  for (int flight = 0; flight < 3; ++flight) landing = descend(mine, landing, random);
  const double far_y = network.graph.nodes[landing].position.y() - 4.0;
  const std::uint32_t lower = network.add_way(landing, drift(0.0, far_y, -kDepth_m), kMineHeight_m);

  constexpr double kLeg_m = 28.0;
  std::uint32_t decline =
      network.add_way(upper, drift(-kLeg_m, 0.0, -kDepth_m / 3.0), kMineHeight_m);
  decline = network.add_way(decline, drift(-kLeg_m, far_y, -2.0 * kDepth_m / 3.0), kMineHeight_m);
  network.join(decline, lower);
  return lower;
}

Mine dig(double length_m, Random random) {
  Mine mine;
  const std::uint32_t door = mine.network.add_node(drift(0.0, 10.0, 0.0), kMineHeight_m);
  const std::uint32_t upper = mine.network.add_way(door, drift(0.0, 0.0, 0.0), kMineHeight_m);
  const std::uint32_t lower = connect_levels(mine, upper, random);
  const double left_m = std::max(100.0, length_m - mine.network.graph.length_m());
  // Drifts above; rooms and pillars below.
  DriftLattice drifts{.length_m = 0.45 * left_m,
                      .pitch_m = 28.0,
                      .half_width_m = kMineHalfWidth_m,
                      .height_m = kMineHeight_m,
                      .relief_m = 1.0,
                      .loop_share = 0.4};
  drifts.may_lie = [](const Eigen::Vector2i& place) { return place.x() >= 1; };
  mine.upper = dig_lattice(mine.network, upper, drifts, random.fork(1));
  DriftLattice rooms{.length_m = 0.55 * left_m,
                     .pitch_m = 11.0,
                     .half_width_m = 2.7,
                     .height_m = 3.2,
                     .relief_m = 0.3,
                     .loop_share = 1.0};
  rooms.may_lie = drifts.may_lie;
  mine.lower = dig_lattice(mine.network, lower, rooms, random.fork(2));
  return mine;
}

void fit_out(World& world, const Mine& mine, Random& random) {
  const Way upper_way = way_to_farthest(mine.network.graph, 0, mine.upper);
  const Way lower_way = way_to_farthest(mine.network.graph, mine.lower.front(), mine.lower);
  lay_rails(world, upper_way);
  lay_rails(world, lower_way);
  hang_cables(world, mine.network, upper_way);
  dangle_cables(world, mine.network, 0.03, random);
  fence_dead_ends(world, mine.network, 0.3, random);
  for (const Stairway& stairs : world.stairways) world.mesh.append(solid_of(stairs));
}

}  // namespace

World make_mine(const WorldSpec& spec) {
  Random random(spec.seed);
  const Mine mine = dig(spec.length_m > 0.0 ? spec.length_m : kMineLength_m, random.fork(1));
  const RockField field({.section = Section::kDrift,
                         .wall_noise_m = 0.2,
                         .wall_wavelength_m = 1.8,
                         .floor_noise_m = 0.04,
                         .merge_m = 0.2,
                         .seed = random.fork(2).next()},
                        mine.network.passages);
  World world;
  world.mesh = mesh_of(field, kMineMeshCell_m);
  world.stairways = mine.stairways;
  world.passages = mine.network.graph;
  world.start = world.passages.nodes[0].position;
  world.start_yaw_rad = heading_rad(world.start, world.passages.nodes[1].position);
  Random fitting_random = random.fork(3);
  fit_out(world, mine, fitting_random);
  scatter_litter(
      world, NodeGrid(world.passages),
      [&field](const Eigen::Vector3d& place) { return field.ground_z(place); },
      {.boulder_share = 0.06, .rubble_share = 0.05, .free_m = 0.7}, fitting_random);
  return world;
}

}  // namespace warren::world
