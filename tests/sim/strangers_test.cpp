// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "tests/sim/measures.hpp"
#include "transport/wire/beacon.hpp"
#include "transport/wire/envelope.hpp"

namespace warren::mesh::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

std::uint64_t unused(Simulation& simulation, std::size_t node, Unused reason) {
  return simulation.node(node).endpoint->counts()[reason];
}

TEST_CASE("strangers get no answer and cause no state") {
  Simulation simulation(two_nodes());
  simulation.start(0);
  simulation.run_until(MeshTime(seconds(1)));
  const std::size_t memory = simulation.node(0).endpoint->memory_bytes();
  std::size_t pair_packets = 0;
  simulation.on_sent = [&](std::size_t, const Datagram& datagram) {
    if (!datagram.to.group) ++pair_packets;
  };
  const PresharedKeys other_keys(Key{9});
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const BootId boot{i + 1};
    const PacketType type = i % 2 == 0 ? PacketType::kBeacon : PacketType::kPair;
    simulation.inject(
        0, 0, simulation.node(1).addresses[0],
        seal(other_keys.group_key(boot), {type, boot, i}, std::vector<std::uint8_t>{1, 2, 3, 4}));
    simulation.run_until(simulation.now() + milliseconds(1));
  }
  CHECK(pair_packets == 0);
  CHECK(unused(simulation, 0, Unused::kNotAuthentic) == 1000);
  CHECK(simulation.node(0).endpoint->memory_bytes() == memory);
  CHECK(simulation.node(0).endpoint->members().empty());
}

TEST_CASE("recorded packets of an earlier life change nothing") {
  Simulation simulation(two_nodes());
  std::vector<Datagram> recorded;
  simulation.on_sent = [&](std::size_t from, const Datagram& datagram) {
    if (from == 1) recorded.push_back(datagram);
  };
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(3)));
  simulation.send_parcel(1, 0, ParcelClass::kMessage, 3000);
  simulation.run_until(MeshTime(seconds(5)));
  simulation.stop(1);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(8)));
  const BootId boot = simulation.node(0).endpoint->members()[0].boot;
  const auto first_life = recorded;
  CHECK(simulation.node(1).members_up[1] == 2);
  for (const Datagram& datagram : first_life) {
    simulation.inject(0, 0, simulation.node(1).addresses[0], datagram.bytes);
  }
  simulation.run_until(MeshTime(seconds(9)));
  CHECK(simulation.node(0).endpoint->members()[0].boot == boot);
  CHECK(unused(simulation, 0, Unused::kRetiredBoot) > 0);
  CHECK(simulation.ledger().failures().empty());
  // Nor in a new life of the receiver, which knows none of it.
  simulation.stop(0);
  simulation.start(0);
  for (const Datagram& datagram : first_life) {
    simulation.inject(0, 0, simulation.node(1).addresses[0], datagram.bytes);
  }
  simulation.run_until(MeshTime(seconds(12)));
  REQUIRE(simulation.node(0).endpoint->members().size() == 1);
  CHECK(simulation.node(0).endpoint->members()[0].boot == boot);
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("a packet of an earlier life that never arrived does not lock out the present one") {
  Simulation::Config config = two_nodes();
  Simulation simulation(config);
  std::vector<Datagram> recorded;
  simulation.on_sent = [&](std::size_t from, const Datagram& datagram) {
    if (from == 1) recorded.push_back(datagram);
  };
  LinkConfig dead = config.networks[0].link;
  dead.loss = 1.0;
  simulation.network().set_link(simulation.now(), 1, 0, dead);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(3)));
  const auto never_arrived = recorded;
  simulation.stop(1);
  simulation.network().set_link(simulation.now(), 1, 0, config.networks[0].link);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(6)));
  REQUIRE(simulation.node(0).endpoint->members().size() == 1);
  const BootId boot = simulation.node(0).endpoint->members()[0].boot;
  for (int round = 0; round < 50; ++round) {
    for (const Datagram& datagram : never_arrived) {
      simulation.inject(0, 0, simulation.node(1).addresses[0], datagram.bytes);
    }
    simulation.run_until(simulation.now() + milliseconds(50));
  }
  CHECK(unused(simulation, 0, Unused::kNotFresh) > 0);
  CHECK(simulation.node(0).endpoint->members()[0].boot == boot);
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 1000);
  CHECK(simulation.run_until(simulation.now() + seconds(2),
                             [&] { return simulation.ledger().outstanding() == 0; }));
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("a restart is noticed at once") {
  std::vector<double> times;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation::Config config = two_nodes();
    config.seed = seed;
    Simulation simulation(config);
    simulation.start(0);
    simulation.start(1);
    simulation.run_until(MeshTime(seconds(5)));
    simulation.stop(1);
    simulation.send_parcel(0, 1, ParcelClass::kMessage, 100);
    simulation.run_until(MeshTime(seconds(6)));
    simulation.start(1);
    const MeshTime start = simulation.now();
    simulation.run_until(start + seconds(5),
                         [&] { return simulation.ledger().outstanding() == 0; });
    times.push_back(in_seconds(simulation.now() - start));
  }
  MESSAGE("from the start of the new life to the parcel: ", quantile(times, 0.5), " s, at most ",
          quantile(times, 1.0), " s");
  CHECK(quantile(times, 1.0) <= 0.3);
}

TEST_CASE("an address change costs nothing but what was on its way") {
  Simulation simulation(two_nodes());
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(5)));
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 200'000);
  simulation.at(MeshTime(milliseconds(5500)), [&] { simulation.change_address(1, 0); });
  simulation.run_until(MeshTime(seconds(20)),
                       [&] { return simulation.ledger().outstanding() == 0; });
  const double s = in_seconds(simulation.now() - MeshTime(seconds(5)));
  MESSAGE("200 kB at 1 Mbit/s with an address change: ", s, " s");
  CHECK(s <= 1.6 * 1.15 + 2.0);
}

TEST_CASE("radios that pass only small packets") {
  Simulation::Config config = two_nodes();
  config.networks[0].link.mtu_bytes = 600;
  Simulation simulation(config);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(3)));
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 500'000);
  simulation.run_until(MeshTime(seconds(60)),
                       [&] { return simulation.ledger().outstanding() == 0; });
  const double s = in_seconds(simulation.now() - MeshTime(seconds(3)));
  MESSAGE("500 kB at 1 Mbit/s in packets of at most 600 bytes: ", s, " s");
  CHECK(s <= 4.0 / 0.7 + 3.0);  // and what it takes to find out
}

TEST_CASE("two nodes with one member id are seen as that") {
  Simulation simulation(two_nodes());
  simulation.start(0);
  const PresharedKeys keys(Key{7});
  const BootId other{77};
  std::vector<std::uint8_t> content = encode(Beacon{{1}, 5, 250, {}});
  simulation.inject(0, 0, simulation.node(1).addresses[0],
                    seal(keys.group_key(other), {PacketType::kBeacon, other, 0}, content));
  CHECK(unused(simulation, 0, Unused::kOwnMember) == 1);
}

TEST_CASE("members_max is kept") {
  Simulation::Config config;
  config.nodes = 6;
  config.networks = {network_of({.rtt = milliseconds(20)})};
  config.members_max = 3;
  Simulation simulation(config);
  for (std::size_t i = 0; i < 6; ++i) simulation.start(i);
  simulation.run_until(MeshTime(seconds(10)));
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(simulation.node(i).endpoint->members().size() <= 3);
    CHECK(unused(simulation, i, Unused::kMemberTableFull) > 0);
  }
}

TEST_CASE("two interfaces: one falls silent, the other carries on") {
  Simulation::Config config = two_nodes();
  config.networks.push_back(config.networks[0]);
  Simulation simulation(config);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(5)));
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 400'000);
  simulation.run_until(MeshTime(seconds(6)));
  const auto used = simulation.node(0).endpoint->members()[0].path.interface;
  simulation.network(used).set_silent(simulation.now(), true);
  CHECK(simulation.run_until(MeshTime(seconds(20)),
                             [&] { return simulation.ledger().outstanding() == 0; }));
  MESSAGE("400 kB, 1 s on one interface, then the other: ",
          in_seconds(simulation.now() - MeshTime(seconds(5))), " s");
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("one sealed packet reaches all who hear") {
  Simulation::Config config;
  config.nodes = 4;
  config.networks = {network_of({.rtt = milliseconds(20)})};
  config.interface.group_broadcast = true;
  Simulation simulation(config);
  for (std::size_t i = 0; i < 4; ++i) simulation.start(i);
  simulation.run_until(MeshTime(seconds(3)));
  simulation.add_group(0, 50'000);
  simulation.run_until(MeshTime(seconds(6)));
  for (std::uint32_t id = 2; id <= 4; ++id) {
    CHECK(simulation.ledger().map_packets_arrived(id, MapClass::kFresh) >= 36);
  }
  CHECK(simulation.ledger().failures().empty());
}

}  // namespace
}  // namespace warren::mesh::sim
