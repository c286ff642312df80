// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <doctest/doctest.h>

#include "tests/sim/measures.hpp"

namespace warren::mesh::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

// No packet between the nodes before `split` and the others, or all as before.
void split_at(Simulation& simulation, const LinkConfig& link, std::size_t split, bool apart) {
  LinkConfig silent = link;
  silent.loss = apart ? 1.0 : link.loss;
  for (StationIndex a = 0; a < simulation.nodes(); ++a) {
    for (StationIndex b = 0; b < simulation.nodes(); ++b) {
      if (a != b && (a < split) != (b < split)) {
        simulation.network().set_link(simulation.now(), a, b, silent);
      }
    }
  }
}

// From the end of a blackout between the first `split` nodes and the others to the first parcel of
// one to the other side.
double reunion(std::size_t nodes, std::size_t split, Duration blackout, double loss,
               std::uint64_t seed, bool both_ways) {
  Simulation::Config config;
  config.nodes = nodes;
  config.seed = seed;
  config.networks = {network_of({.rtt = milliseconds(50), .loss = loss})};
  const LinkConfig link = config.networks[0].link;
  Simulation simulation(config);
  for (std::size_t i = 0; i < nodes; ++i) simulation.start(i);
  simulation.run_until(MeshTime(seconds(8)));
  split_at(simulation, link, split, true);
  simulation.run_until(simulation.now() + blackout / 2);
  // Data waits since long: of the lone one for all, or of one of the others for it.
  for (std::size_t other = split; other < nodes; ++other) {
    simulation.send_parcel(0, other, ParcelClass::kMessage, 100);
    if (both_ways) simulation.send_parcel(other, 0, ParcelClass::kMessage, 100);
  }
  simulation.run_until(simulation.now() + blackout / 2 + milliseconds(seed * 37 % 1000));
  const std::size_t before = simulation.ledger().outstanding();
  split_at(simulation, link, split, false);
  const MeshTime healed = simulation.now();
  simulation.run_until(healed + seconds(20),
                       [&] { return simulation.ledger().outstanding() < before; });
  CHECK(simulation.ledger().failures().empty());
  return in_seconds(simulation.now() - healed);
}

void check(const std::string& name, std::size_t nodes, Duration blackout, double loss, int runs,
           double p99) {
  std::vector<double> times;
  for (int i = 1; i <= runs; ++i) {
    times.push_back(reunion(nodes, 1, blackout, loss, static_cast<std::uint64_t>(i), i % 2 == 0));
  }
  MESSAGE(name, ": median ", quantile(times, 0.5), " s, p99 ", quantile(times, 0.99), " s");
  CHECK(quantile(times, 0.5) <= 0.3);
  CHECK(quantile(times, 0.99) <= p99);
}

TEST_CASE("the first byte after a blackout of a minute") {
  check("2 nodes", 2, minutes(1), 0.0, 100, 1.0);
  check("10 nodes", 10, minutes(1), 0.0, 50, 1.0);
  check("2 nodes, loss 40 %", 2, minutes(1), 0.4, 100, 2.0);
  check("10 nodes, loss 40 %", 10, minutes(1), 0.4, 50, 2.0);
}

TEST_CASE("the first byte after a blackout of an hour") {
  check("2 nodes", 2, minutes(60), 0.0, 10, 1.0);
  check("10 nodes", 10, minutes(60), 0.0, 3, 1.0);
}

TEST_CASE("two groups of five meet") {
  std::vector<double> all_up;
  std::vector<double> first_byte;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Simulation::Config config;
    config.nodes = 10;
    config.seed = seed;
    config.networks = {network_of({.rtt = milliseconds(50)})};
    const LinkConfig link = config.networks[0].link;
    Simulation simulation(config);
    split_at(simulation, link, 5, true);
    for (std::size_t i = 0; i < 10; ++i) simulation.start(i);
    simulation.run_until(MeshTime(seconds(20) + milliseconds(seed * 53)));
    simulation.send_parcel(2, 7, ParcelClass::kMessage, 100);
    split_at(simulation, link, 5, false);
    const MeshTime met = simulation.now();
    simulation.run_until(met + seconds(10), [&] { return simulation.ledger().outstanding() == 0; });
    first_byte.push_back(in_seconds(simulation.now() - met));
    const auto everybody = [&] {
      for (std::size_t i = 0; i < 10; ++i) {
        if (simulation.node(i).members_up.size() < 9) return false;
      }
      return true;
    };
    simulation.run_until(met + seconds(10), everybody);
    all_up.push_back(in_seconds(simulation.now() - met));
  }
  MESSAGE("first byte: median ", quantile(first_byte, 0.5), " s, p99 ", quantile(first_byte, 0.99),
          " s; all 25 pairs: median ", quantile(all_up, 0.5), " s, p99 ", quantile(all_up, 0.99));
  CHECK(quantile(first_byte, 0.99) <= 1.5);
}

TEST_CASE("an idle node costs at most a kilobit per second") {
  for (const std::size_t nodes : {2U, 10U, 31U}) {
    Simulation::Config config;
    config.nodes = nodes;
    config.networks = {network_of({.bit_s = 10e6, .rtt = milliseconds(20)})};
    Simulation simulation(config);
    for (std::size_t i = 0; i < nodes; ++i) simulation.start(i);
    simulation.run_until(MeshTime(seconds(20)));
    const std::uint64_t before = simulation.network().counts(StationIndex{0}).sent_bytes;
    simulation.run_until(MeshTime(seconds(120)));
    const std::uint64_t after = simulation.network().counts(StationIndex{0}).sent_bytes;
    const double bit_s = static_cast<double>(after - before) * 8.0 / 100.0;
    MESSAGE(nodes, " nodes: ", bit_s, " bit/s each");
    CHECK(bit_s <= 1000.0);
    for (std::size_t i = 0; i < nodes; ++i) {
      CHECK(simulation.node(i).members_up.size() == nodes - 1);
    }
  }
}

}  // namespace
}  // namespace warren::mesh::sim
