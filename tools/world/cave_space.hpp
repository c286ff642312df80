// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/world/network.hpp"
#include "tools/world/node_grid.hpp"

namespace warren::world {

using Nodes = std::vector<std::uint32_t>;

// What of a growing cave is taken, and what a new passage may not do to it. Its kin are the nodes,
// by index, that a passage may touch: those just behind.
struct CaveSpace {
  static constexpr double kBrink_m = 1.0;  // from a way to a pit
  struct Chamber {
    std::uint32_t node;
    double radius_m;
  };

  CaveSpace() = default;
  CaveSpace(const CaveSpace&) = delete;  // the grid points to the network
  CaveSpace& operator=(const CaveSpace&) = delete;

  bool is_over_pit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  // Whether a passage at a place would break into another than its kin.
  bool stranger_at(const Eigen::Vector3d& place, double half_width_m, const Nodes& kin) const;
  // Whether floors side by side would differ so much in height that the ground between them were a
  // scarp: a place against its kin, apart from the trail that leads to it.
  bool tilts(const Eigen::Vector3d& place, double half_width_m, const Nodes& kin,
             const Nodes& trail) const;

  Network network;
  NodeGrid grid{network.graph};
  std::vector<Chamber> chambers;

 private:
  double reach_m(std::uint32_t node) const;
};

}  // namespace warren::world
