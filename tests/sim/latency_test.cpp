// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "tests/sim/measures.hpp"

namespace warren::mesh::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::vector<double> seconds_of(const std::vector<Duration>& latencies) {
  std::vector<double> values;
  for (const Duration latency : latencies) values.push_back(in_seconds(latency));
  return values;
}

// Half a round trip, two packets of 1428 bytes, 50 ms.
constexpr double kTarget = 0.050 + 2.0 * 1428.0 * 8.0 / 1e6 + 0.050;

struct Latencies {
  double telemetry_p99 = 0.0;
  double urgent_p99 = 0.0;
  std::size_t telemetry = 0;
  std::size_t urgent = 0;
  double rate_bit_s = 0.0;  // that the sender believes in
};

// With a backlog without end from node 0 to node 1.
Latencies under_load(double loss, std::uint64_t seed) {
  Simulation::Config config;
  config.seed = seed;
  config.networks = {network_of({.loss = loss})};
  Simulation simulation(config);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(3)));
  simulation.add_map(0, 1, MapClass::kBacklog, 100'000'000);
  simulation.run_until(MeshTime(seconds(13)));
  simulation.node(1).urgent_latency.clear();
  simulation.node(1).telemetry_latency.clear();
  for (int i = 0; i < 400; ++i) {
    const MeshTime when = simulation.now() + milliseconds(i * 97);
    if (i % 2 == 0) {
      simulation.at(when, [&] { simulation.set_telemetry(0, 1); });
    } else {
      simulation.at(when, [&] { simulation.send_urgent(0, 1); });
    }
  }
  simulation.run_until(simulation.now() + seconds(42));
  CHECK(simulation.ledger().failures().empty());
  const auto& node = simulation.node(1);
  return {quantile(seconds_of(node.telemetry_latency), 0.99),
          quantile(seconds_of(node.urgent_latency), 0.99), node.telemetry_latency.size(),
          node.urgent_latency.size(),
          simulation.node(0).endpoint->members().front().link.rate_bit_s};
}

TEST_CASE("telemetry and urgent messages under a saturating backlog") {
  std::vector<double> telemetry;
  std::vector<double> urgent;
  std::vector<double> urgent_lossy;
  std::vector<double> rate;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Latencies clean = under_load(0.0, seed);
    const Latencies lossy = under_load(0.2, seed);
    CHECK(clean.telemetry == 200);
    CHECK(clean.urgent == 200);
    CHECK(lossy.urgent >= 199);
    telemetry.push_back(clean.telemetry_p99);
    urgent.push_back(clean.urgent_p99);
    urgent_lossy.push_back(lossy.urgent_p99);
    rate.push_back(clean.rate_bit_s);
  }
  MESSAGE("p99: telemetry ", quantile(telemetry, 0.5), " s, urgent ", quantile(urgent, 0.5),
          " s, urgent at loss 20 % ", quantile(urgent_lossy, 0.5), " s; target ", kTarget, " s");
  CHECK(quantile(telemetry, 0.5) <= kTarget);
  CHECK(quantile(urgent, 0.5) <= kTarget);
  CHECK(quantile(urgent_lossy, 0.5) <= kTarget);
  // Small packets between the paced ones do not make the link look faster than it is.
  CHECK(quantile(rate, 0.5) <= 1.04e6);
}

TEST_CASE("no class starves another") {
  Simulation::Config config;
  config.networks = {network_of({})};
  Simulation simulation(config);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(3)));
  simulation.add_map(0, 1, MapClass::kBacklog, 100'000'000);
  simulation.add_map(0, 1, MapClass::kFresh, 100'000'000);
  std::size_t fresh = 0;
  std::size_t backlog = 0;
  std::size_t parcels = 0;
  for (int window = 0; window < 10; ++window) {
    for (int i = 0; i < 8; ++i) simulation.send_parcel(0, 1, ParcelClass::kMessage, 40'000);
    for (int i = 0; i < 20; ++i) {
      simulation.set_telemetry(0, static_cast<std::uint16_t>(i % 3), 500);
      simulation.run_until(simulation.now() + milliseconds(100));
    }
    const Ledger& ledger = simulation.ledger();
    const std::size_t arrived = ledger.parcels().size() - ledger.outstanding();
    CHECK(ledger.map_packets_arrived(2, MapClass::kFresh) > fresh);
    CHECK(ledger.map_packets_arrived(2, MapClass::kBacklog) > backlog);
    if (window > 0) CHECK(arrived > parcels);
    fresh = ledger.map_packets_arrived(2, MapClass::kFresh);
    backlog = ledger.map_packets_arrived(2, MapClass::kBacklog);
    parcels = arrived;
  }
  MESSAGE("packets of fresh ", fresh, ", backlog ", backlog, "; parcels ", parcels);
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("two flows share a medium fairly") {
  std::vector<double> fairness;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Simulation::Config config;
    config.nodes = 4;
    config.seed = seed;
    config.networks = {network_of({})};
    config.networks[0].shared_airtime = true;
    Simulation simulation(config);
    for (std::size_t i = 0; i < 4; ++i) simulation.start(i);
    simulation.run_until(MeshTime(seconds(3)));
    simulation.add_map(0, 1, MapClass::kBacklog, 100'000'000);
    simulation.run_until(MeshTime(seconds(8)));
    simulation.add_map(2, 3, MapClass::kBacklog, 100'000'000);
    simulation.run_until(MeshTime(seconds(13)));
    const auto delivered = [&](std::size_t node) {
      return static_cast<double>(simulation.node(node).source->delivered_bytes(MapClass::kBacklog));
    };
    const double a0 = delivered(0);
    const double b0 = delivered(2);
    simulation.run_until(MeshTime(seconds(53)));
    const double a = delivered(0) - a0;
    const double b = delivered(2) - b0;
    fairness.push_back((a + b) * (a + b) / (2.0 * (a * a + b * b)));
    MESSAGE("seed ", seed, ": ", a * 8 / 40e6, " and ", b * 8 / 40e6, " of the medium");
  }
  MESSAGE("Jain's index ", quantile(fairness, 0.5));
  CHECK(quantile(fairness, 0.5) >= 0.9);
}

TEST_CASE("the rate follows steps of the link") {
  for (const std::size_t queue_ms : {25U, 100U, 300U, 1000U}) {
    std::vector<double> late_queue;
    std::vector<double> use_down;
    std::vector<double> use_up;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Simulation::Config config;
      config.seed = seed;
      config.networks = {network_of({.queue = milliseconds(queue_ms)})};
      config.networks[0].link.capacity =
          Capacity({{{}, 1e6}, {seconds(20), 1e5}, {seconds(40), 1e6}});
      Simulation simulation(config);
      simulation.start(0);
      simulation.start(1);
      simulation.run_until(MeshTime(seconds(3)));
      simulation.add_map(0, 1, MapClass::kBacklog, 100'000'000);
      const auto delivered_by = [&](Duration time) {
        simulation.run_until(MeshTime(time));
        return static_cast<double>(simulation.node(0).source->delivered_bytes(MapClass::kBacklog));
      };
      double worst = 0.0;
      const auto watch = [&](Duration from, Duration to, double bit_s) {
        simulation.run_until(MeshTime(from));
        while (simulation.now() < MeshTime(to)) {
          simulation.run_until(simulation.now() + milliseconds(20));
          const double waiting =
              static_cast<double>(simulation.network().queued_bytes(0)) * 8.0 / bit_s;
          worst = std::max(worst, waiting);
        }
      };
      const double down_start = delivered_by(seconds(23));
      watch(seconds(23), seconds(40), 1e5);
      use_down.push_back((delivered_by(seconds(40)) - down_start) * 8.0 / (17.0 * 1e5));
      const double up_start = delivered_by(seconds(43));
      watch(seconds(43), seconds(60), 1e6);
      use_up.push_back((delivered_by(seconds(60)) - up_start) * 8.0 / (17.0 * 1e6));
      late_queue.push_back(worst);
    }
    MESSAGE("buffer ", queue_ms, " ms: 3 s after the steps ", quantile(use_down, 0.5), " and ",
            quantile(use_up, 0.5), " of the rate, queue at most ", quantile(late_queue, 0.5), " s");
    // A packet on the air at 100 kbit/s is 114 ms itself.
    WARN(quantile(late_queue, 0.5) <= 0.15 + 0.03);
    CHECK(quantile(late_queue, 0.5) <= 0.28);
    CHECK(quantile(use_down, 0.5) >= 0.8);
    CHECK(quantile(use_up, 0.5) >= 0.9);
  }
}

}  // namespace
}  // namespace warren::mesh::sim
