// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/sim/simulation.hpp"

namespace warren::mesh::sim {

struct ScenarioOutcome {
  std::vector<std::string> failures;
  std::string story;     // what the links were and what was done to the nodes
  double seconds = 0.0;  // of virtual time
  // How much longer it took than 1.25 times the theoretical time and 2 s; 0: it did not.
  double late_s = 0.0;
};

// A small fleet, links, loads and troubles, all drawn from the seed. Afterwards everything heals,
// and what was promised must be kept.
ScenarioOutcome run_scenario(std::uint64_t seed, Planted planted = Planted::kNone);

}  // namespace warren::mesh::sim
