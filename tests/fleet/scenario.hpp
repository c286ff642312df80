// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/fleet/fleet.hpp"

namespace warren::fleet_sim {

struct Outcome {
  std::vector<std::string> failures;
  std::string story;
  double loss = 0.0;       // of every link, when all is well
  bool near = false;       // some nodes want only what is near them
  double seconds = 0.0;    // of virtual time
  double healing_s = 0.0;  // from the moment that all is well until all are equal
  Fleet::Packets packets;
  std::uint64_t quiet_bytes = 0;  // said in a minute of peace afterwards, beacons left out
};

// A fleet, its radios and its troubles, all drawn from the seed; then all heals, writing stops, and
// everybody must come to have the same.
Outcome run_scenario(std::uint64_t seed, Planted planted = Planted::kNone);

}  // namespace warren::fleet_sim
