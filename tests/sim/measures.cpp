// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/measures.hpp"

#include <cmath>

namespace warren::mesh::sim {

LinkModelConfig network_of(const RadioLink& radio) {
  LinkModelConfig network;
  network.queue.packets = SIZE_MAX;
  network.queue.time = radio.queue;
  network.link.capacity = Capacity(radio.bit_s);
  network.link.delay = radio.rtt / 2;
  network.link.loss = radio.loss;
  if (radio.burst_loss > 0.0) {
    network.link.burst_loss = BurstLoss{radio.burst_loss, radio.burst_packets};
  }
  return network;
}

Simulation::Config two_nodes() {
  Simulation::Config config;
  config.networks = {network_of({.rtt = std::chrono::milliseconds(20)})};
  return config;
}

Transferred transfer(const RadioLink& radio, std::size_t bytes, std::uint64_t seed) {
  constexpr std::size_t kParcelBytes = 200'000;
  Simulation::Config config;
  config.networks = {network_of(radio)};
  config.seed = seed;
  Simulation simulation(config);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(std::chrono::seconds(3)));
  const std::uint64_t sent_before = simulation.network().counts(StationIndex{0}).sent_bytes;
  const MeshTime start = simulation.now();
  std::size_t left = bytes;
  const auto feed = [&] {
    while (left > 0 && simulation.ledger().outstanding() < 16) {
      const std::size_t next = std::min(left, kParcelBytes);
      if (!simulation.send_parcel(0, 1, ParcelClass::kMessage, next)) return;
      left -= next;
    }
  };
  feed();
  const double loss = 1.0 - (1.0 - radio.loss) * (1.0 - radio.burst_loss);
  const double ideal_s = static_cast<double>(bytes) * 8.0 / (radio.bit_s * (1.0 - loss));
  const auto limit =
      std::chrono::duration_cast<Duration>(std::chrono::duration<double>(10.0 * ideal_s + 30.0));
  simulation.run_until(start + limit, [&] {
    feed();
    return left == 0 && simulation.ledger().outstanding() == 0;
  });
  Transferred result;
  result.efficiency = ideal_s / in_seconds(simulation.now() - start);
  const StationCounts& counts = simulation.network().counts(StationIndex{0});
  result.oversend = static_cast<double>(counts.sent_bytes - sent_before) * (1.0 - loss) /
                    static_cast<double>(bytes);
  result.queue_s = in_seconds(counts.queue_time_max);
  result.failures = simulation.ledger().failures().size();
  return result;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const auto at =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  return values[at];
}

}  // namespace warren::mesh::sim
