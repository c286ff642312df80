// SPDX-License-Identifier: Apache-2.0
#include "tools/world/furnish.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "tools/world/boulders.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

// How much rounder than its radius a boulder may bulge.
constexpr double kBulge = 1.35;

class Litterer {
 public:
  Litterer(World& world, const NodeGrid& grid, const Ground& ground, const Litter& litter)
      : world_(world), grid_(grid), ground_(ground), litter_(litter) {}

  void drop_boulder(const PassageGraph::Node& node, Random& random) {
    const double radius_m = random.uniform(litter_.boulder_min_m, litter_.boulder_max_m) *
                            std::min(1.5, node.half_width_m / 2.0);
    const auto place = find_place(node, kBulge * radius_m, random);
    if (!place) return;
    const Eigen::Vector3d sunk = *place + 0.4 * radius_m * Eigen::Vector3d::UnitZ();
    const Boulder shape{.radius_m = radius_m, .refinements = radius_m > 0.4 ? 3 : 2};
    world_.mesh.append(boulder(shape, random), upright(sunk, random.uniform(0.0, 6.28)));
  }

  void drop_rubble(const PassageGraph::Node& node, Random& random) {
    const RubblePile pile{.radius_m = random.uniform(0.4, 0.9),
                          .height_m = random.uniform(0.2, 0.5),
                          .stones = static_cast<int>(15 + random.below(25))};
    const auto place = find_place(node, pile.radius_m + 0.1, random);
    if (place) world_.mesh.append(rubble_pile(pile, random), upright(*place, 0.0));
  }

 private:
  // On the ground, so far from the paths that something of a radius leaves them free.
  std::optional<Eigen::Vector3d> find_place(const PassageGraph::Node& node, double radius_m,
                                            Random& random) const {
    constexpr int kAttempts = 6;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const double azimuth_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
      const double away_m = random.uniform(0.5, 1.0) * node.half_width_m;
      Eigen::Vector3d place = node.position + away_m * Eigen::Vector3d(std::cos(azimuth_rad),
                                                                       std::sin(azimuth_rad), 0.0);
      const double needed_m = radius_m + litter_.free_m;
      if (grid_.to_path_m(place, needed_m) < needed_m) continue;
      place.z() = ground_(place + 0.8 * Eigen::Vector3d::UnitZ());
      if (std::abs(place.z() - node.position.z()) < 1.5) return place;
    }
    return std::nullopt;
  }

  World& world_;
  const NodeGrid& grid_;
  const Ground& ground_;
  const Litter& litter_;
};

}  // namespace

void scatter_litter(World& world, const NodeGrid& grid, const Ground& ground, const Litter& litter,
                    Random& random) {
  Litterer litterer(world, grid, ground, litter);
  for (const PassageGraph::Node& node : world.passages.nodes) {
    if (random.chance(litter.boulder_share)) litterer.drop_boulder(node, random);
    if (random.chance(litter.rubble_share)) litterer.drop_rubble(node, random);
  }
}

}  // namespace warren::world
