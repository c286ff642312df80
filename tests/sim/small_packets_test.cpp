// SPDX-License-Identifier: Apache-2.0
// Radios that pass only small packets, whether that is configured or has to be found out; and map
// sources that cannot do with less than so many bytes.
#include <doctest/doctest.h>

#include "tests/sim/measures.hpp"

namespace warren::mesh::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kHeaders = 28 + 32 + 1;  // IP, UDP, envelope, type of the map frame
constexpr std::size_t kDiffPacket = 440;       // the least that a diff packet needs

Simulation::Config radio_of(std::size_t mtu_bytes, double bit_s = 1e6) {
  Simulation::Config config;
  config.networks = {network_of({.bit_s = bit_s, .rtt = milliseconds(40), .loss = 0.05})};
  config.networks[0].link.mtu_bytes = mtu_bytes;
  config.interface.mtu_bytes = mtu_bytes;
  return config;
}

void start_both(Simulation& simulation, std::size_t map_bytes_min = kStampBytes) {
  for (std::size_t i = 0; i < 2; ++i) {
    simulation.node(i).source->packet_bytes_min = map_bytes_min;
    simulation.start(i);
  }
  simulation.run_until(MeshTime(seconds(2)));
}

TEST_CASE("everything passes in small packets, down to the least MTU that is served") {
  for (const std::size_t ip_header : {28U, 48U}) {
    for (const std::size_t mtu : {InterfaceConfig::kMtuLeast, std::size_t{400}, std::size_t{600}}) {
      Simulation::Config config = radio_of(mtu);
      config.interface.ip_header_bytes = ip_header;
      config.interface.group_broadcast = true;
      Simulation simulation(config);
      start_both(simulation);
      simulation.send_parcel(0, 1, ParcelClass::kMessage, 50'000);
      simulation.send_parcel(1, 0, ParcelClass::kControl, 50'000);
      simulation.set_telemetry(0, 1, 100);
      simulation.set_telemetry(0, 2, 1000);
      simulation.send_urgent(0, 1);
      simulation.add_map(0, 1, MapClass::kFresh, 10'000);
      simulation.add_map(1, 0, MapClass::kBacklog, 10'000);
      simulation.add_group(0, 2'000);
      const bool done = simulation.run_until(MeshTime(seconds(10)), [&] {
        return simulation.ledger().outstanding() == 0 &&
               simulation.node(0).source->open_bytes() == 0 &&
               simulation.node(1).source->open_bytes() == 0;
      });
      CAPTURE(mtu);
      CAPTURE(ip_header);
      CHECK(done);
      CHECK(simulation.node(1).urgent_latency.size() == 1);
      CHECK(simulation.node(1).telemetry_latency.size() == 1);
      CHECK(simulation.node(0).endpoint->counts().outbox.telemetry_oversized >= 1);
      CHECK(simulation.network().counts(0, 1).dropped_too_large == 0);
      CHECK(simulation.ledger().failures().empty());
    }
  }
}

// Seconds until the map is over; none if it is not within a minute.
std::optional<double> map_time(Simulation& simulation, std::size_t bytes) {
  const MeshTime start = simulation.now();
  simulation.add_map(0, 1, MapClass::kFresh, bytes);
  const bool done = simulation.run_until(
      start + seconds(60), [&] { return simulation.node(0).source->open_bytes() == 0; });
  CHECK(simulation.ledger().failures().empty());
  if (!done) return {};
  return in_seconds(simulation.now() - start);
}

TEST_CASE("a map source is not asked for less than it needs, and gets that where it fits") {
  for (const std::size_t mtu : {kHeaders + kDiffPacket, std::size_t{576}, std::size_t{640}}) {
    Simulation simulation(radio_of(mtu));
    start_both(simulation, kDiffPacket);
    const auto s = map_time(simulation, 50'000);
    CAPTURE(mtu);
    REQUIRE(s);
    CHECK(*s <= 4.0);
  }
}

TEST_CASE("on a slow link the first and all map packets are as large as the source needs") {
  Simulation simulation(radio_of(1428, 50e3));
  start_both(simulation, kDiffPacket);
  const auto s = map_time(simulation, 20'000);
  REQUIRE(s);
  MESSAGE("20 kB of map at 50 kbit/s, loss 5 %, in packets of 440 bytes: ", *s, " s");
  CHECK(*s <= 2.0 * 20'000 * 8 / 50e3);
}

TEST_CASE("a link that is found to pass small packets only carries the map too") {
  Simulation::Config config = radio_of(1428);
  config.networks[0].link.mtu_bytes = 600;
  Simulation simulation(config);
  start_both(simulation, kDiffPacket);
  CHECK(map_time(simulation, 200'000));
}

TEST_CASE("where the map cannot pass it is not asked for, and nothing waits or spins for it") {
  Simulation::Config config = radio_of(kHeaders + kDiffPacket - 1);
  config.interface.group_broadcast = true;
  Simulation simulation(config);
  start_both(simulation, kDiffPacket);
  simulation.add_map(0, 1, MapClass::kFresh, 1000);
  simulation.add_group(0, 1000);
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 20'000);
  simulation.run_until(MeshTime(milliseconds(9'950)));
  CHECK(simulation.ledger().outstanding() == 0);
  CHECK(simulation.node(0).source->open_bytes() == 1000);
  CHECK(simulation.node(0).polls < 60);  // of the last second
  CHECK(simulation.ledger().failures().empty());
}

}  // namespace
}  // namespace warren::mesh::sim
