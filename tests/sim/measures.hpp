// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "tests/sim/simulation.hpp"
#include "transport/flow/seconds.hpp"

namespace warren::mesh::sim {

// One direction of a radio.
struct RadioLink {
  double bit_s = 1e6;
  Duration rtt = std::chrono::milliseconds(100);
  double loss = 0.0;  // both ways
  double burst_loss = 0.0;
  double burst_packets = 20.0;
  Duration queue = std::chrono::milliseconds(1000);
};
LinkModelConfig network_of(const RadioLink& radio);
// Two nodes, 1 Mbit/s, a round trip of 20 ms, no loss.
Simulation::Config two_nodes();

struct Transferred {
  double efficiency = 0.0;  // application bits per second, of the rate times what is not lost
  double oversend = 0.0;    // bytes that the sender put on the link / payload / (1 - loss)
  double queue_s = 0.0;     // the longest wait in the link's queue
  std::size_t failures = 0;
};
// From the moment that both are up to the last byte, by parcels of 200 kB and the rest.
Transferred transfer(const RadioLink& radio, std::size_t bytes, std::uint64_t seed);

template <typename Run>
auto median_of_five(Run&& run) {
  std::vector<decltype(run(std::uint64_t{1}))> values;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) values.push_back(run(seed));
  std::sort(values.begin(), values.end());
  return values[2];
}

double quantile(std::vector<double> values, double share);

}  // namespace warren::mesh::sim
