// SPDX-License-Identifier: Apache-2.0
#include "tools/world/cave_growth.hpp"
#include "tools/world/furnish.hpp"
#include "tools/world/presets.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

constexpr double kCaveLength_m = 250.0;
constexpr double kCaveMeshCell_m = 0.2;

RockField::Settings rock(std::uint64_t seed) {
  return {.section = Section::kOval,
          .wall_noise_m = 0.3,
          .wall_wavelength_m = 2.6,
          .floor_noise_m = 0.08,
          .merge_m = 0.5,
          .seed = seed};
}

}  // namespace

World make_cave(const WorldSpec& spec) {
  Random random(spec.seed);
  const Network network =
      grow_cave(spec.length_m > 0.0 ? spec.length_m : kCaveLength_m, random.fork(1));
  const RockField field(rock(random.fork(2).next()), network.passages, network.shafts);

  World world;
  world.mesh = mesh_of(field, kCaveMeshCell_m);
  world.passages = network.graph;
  world.start = world.passages.nodes[0].position;
  world.start_yaw_rad = heading_rad(world.start, world.passages.nodes[1].position);
  Random litter_random = random.fork(3);
  scatter_litter(
      world, NodeGrid(world.passages),
      [&field](const Eigen::Vector3d& place) { return field.ground_z(place); },
      {.boulder_share = 0.15, .rubble_share = 0.06}, litter_random);
  return world;
}

}  // namespace warren::world
