// SPDX-License-Identifier: Apache-2.0
#include "tools/world/cave_space.hpp"

#include <algorithm>
#include <cmath>

namespace warren::world {
namespace {

constexpr double kRockBetween_m = 1.8;  // that strangers leave standing

}  // namespace

// Half the room at a node: its chamber's if it has one.
double CaveSpace::reach_m(std::uint32_t node) const {
  for (const Chamber& chamber : chambers)
    if (chamber.node == node) return chamber.radius_m;
  return network.graph.nodes[node].half_width_m;
}

bool CaveSpace::is_over_pit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  constexpr int kProbes = 8;
  for (const Shaft& shaft : network.shafts) {
    for (int i = 0; i <= kProbes; ++i) {
      const Eigen::Vector3d probe = from + (to - from) * i / kProbes;
      if ((probe - shaft.bottom).head<2>().norm() < shaft.radius_m + kBrink_m) return true;
    }
  }
  return false;
}

bool CaveSpace::stranger_at(const Eigen::Vector3d& place, double half_width_m,
                            const Nodes& kin) const {
  constexpr double kWidest_m = 6.5;
  const auto is_stranger = [&](std::uint32_t other) {
    if (std::binary_search(kin.begin(), kin.end(), other)) return false;
    const Eigen::Vector3d away = network.graph.nodes[other].position - place;
    if (away.head<2>().norm() > half_width_m + kRockBetween_m + reach_m(other)) return false;
    const double roof_m = away.z() < 0.0 ? network.height_m[other] : 4.0;
    return std::abs(away.z()) <= roof_m + kRockBetween_m;
  };
  const auto near = grid.within(place, half_width_m + kRockBetween_m + kWidest_m);
  return std::any_of(near.begin(), near.end(), is_stranger);
}

bool CaveSpace::tilts(const Eigen::Vector3d& place, double half_width_m, const Nodes& kin,
                      const Nodes& trail) const {
  constexpr double kTilt = 0.3;
  const auto is_scarp = [&](std::uint32_t other) {
    if (std::find(trail.begin(), trail.end(), other) != trail.end()) return false;
    const PassageGraph::Node& node = network.graph.nodes[other];
    const Eigen::Vector3d away = node.position - place;
    const double apart_m = away.head<2>().norm();
    if (apart_m > half_width_m + node.half_width_m + 0.5) return false;
    return std::abs(away.z()) > kTilt * apart_m + 0.1;
  };
  return std::any_of(kin.begin(), kin.end(), is_scarp);
}

}  // namespace warren::world
