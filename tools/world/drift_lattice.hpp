// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "tools/world/network.hpp"
#include "tools/world/random.hpp"

namespace warren::world {

struct DriftLattice {
  double length_m = 300.0;  // of all drifts, about
  double pitch_m = 22.0;    // between parallel drifts
  double half_width_m = 1.8;
  double height_m = 2.8;
  double relief_m = 0.8;    // ups and downs of the floor
  double loop_share = 0.5;  // of the drifts that would close a loop and may be dug; 1: a full grid
  // Where a junction may lie, in pitches from the first.
  std::function<bool(const Eigen::Vector2i&)> may_lie = [](const Eigen::Vector2i&) { return true; };
};

// Digs straight drifts that meet at right angles, from a node on; the junctions, that node first.
std::vector<std::uint32_t> dig_lattice(Network& network, std::uint32_t from,
                                       const DriftLattice& settings, Random random);

}  // namespace warren::world
