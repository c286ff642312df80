// SPDX-License-Identifier: Apache-2.0
// A full table of members: who gives way, who does not, and what of those who come back.
#include <doctest/doctest.h>

#include "tests/sim/measures.hpp"

namespace warren::mesh::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

// Node 0 knows two at most.
Simulation::Config fleet() {
  Simulation::Config config = two_nodes();
  config.nodes = 5;
  config.members_max = 2;
  return config;
}

bool knows(Simulation& simulation, std::uint32_t id) {
  const auto members = simulation.node(0).endpoint->members();
  return std::any_of(members.begin(), members.end(),
                     [&](const Member& member) { return member.id.number == id; });
}

void run(Simulation& simulation, Duration time) { simulation.run_until(simulation.now() + time); }

// No packet between node 0 and another one.
void part(Simulation& simulation, StationIndex other, bool apart) {
  LinkConfig link = fleet().networks[0].link;
  if (apart) link.loss = 1.0;
  simulation.network().set_link(simulation.now(), 0, other, link);
  simulation.network().set_link(simulation.now(), other, 0, link);
}

TEST_CASE("a full table forgets who was silent for longest, but nobody who was heard lately") {
  Simulation simulation(fleet());
  for (const std::size_t i : {0U, 1U, 2U}) simulation.start(i);
  run(simulation, seconds(5));
  simulation.stop(1);
  run(simulation, seconds(30));
  simulation.stop(2);
  run(simulation, minutes(5));
  simulation.start(3);
  run(simulation, seconds(10));
  CHECK(!knows(simulation, 4));
  EndpointCounts counts = simulation.node(0).endpoint->counts();
  CHECK(counts[Unused::kMemberTableFull] > 0);
  CHECK(counts.members_forgotten == 0);
  run(simulation, minutes(5));
  CHECK(knows(simulation, 4));
  CHECK(knows(simulation, 3));
  CHECK(!knows(simulation, 2));
  counts = simulation.node(0).endpoint->counts();
  CHECK(counts.members_forgotten == 1);
  simulation.send_parcel(0, 3, ParcelClass::kMessage, 1000);
  simulation.send_parcel(3, 0, ParcelClass::kMessage, 1000);
  CHECK(simulation.run_until(simulation.now() + seconds(2),
                             [&] { return simulation.ledger().outstanding() == 0; }));
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("a member with an unfinished parcel is not forgotten") {
  Simulation simulation(fleet());
  for (const std::size_t i : {0U, 1U, 2U}) simulation.start(i);
  run(simulation, seconds(5));
  simulation.stop(1);
  run(simulation, seconds(10));
  simulation.stop(2);
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 1000);
  run(simulation, minutes(11));
  simulation.start(3);
  run(simulation, seconds(5));
  CHECK(knows(simulation, 2));
  CHECK(!knows(simulation, 3));
  CHECK(knows(simulation, 4));
  simulation.start(1);
  CHECK(simulation.run_until(simulation.now() + seconds(2),
                             [&] { return simulation.ledger().outstanding() == 0; }));
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("a table full of members of an earlier life makes room too") {
  Simulation simulation(fleet());
  for (const std::size_t i : {0U, 1U, 2U}) simulation.start(i);
  run(simulation, seconds(5));
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 100);
  simulation.send_parcel(0, 2, ParcelClass::kMessage, 100);
  run(simulation, seconds(2));
  REQUIRE(simulation.ledger().outstanding() == 0);
  for (const std::size_t i : {0U, 1U, 2U}) simulation.stop(i);
  simulation.start(0);
  simulation.start(3);
  run(simulation, minutes(2));
  CHECK(!knows(simulation, 4));
  run(simulation, minutes(9));
  CHECK(knows(simulation, 4));
  CHECK(simulation.node(0).endpoint->counts().members_forgotten == 1);
}

TEST_CASE("who was forgotten and comes back in the same life is heard and served as before") {
  Simulation simulation(fleet());
  for (const std::size_t i : {0U, 1U}) simulation.start(i);
  run(simulation, seconds(5));
  for (int i = 0; i < 20; ++i) simulation.send_urgent(0, 1);
  simulation.send_parcel(1, 0, ParcelClass::kMessage, 300'000);
  run(simulation, seconds(1));  // some of it has come
  part(simulation, 1, true);
  simulation.start(2);
  run(simulation, minutes(11));
  simulation.stop(2);
  simulation.start(3);
  run(simulation, seconds(10));
  REQUIRE(!knows(simulation, 2));
  REQUIRE(simulation.node(0).endpoint->counts().members_forgotten == 1);
  run(simulation, minutes(11));  // the one that stopped gives way in turn
  const std::size_t urgent = simulation.node(1).urgent_latency.size();
  part(simulation, 1, false);
  CHECK(simulation.run_until(simulation.now() + seconds(8),
                             [&] { return simulation.ledger().outstanding() == 0; }));
  CHECK(knows(simulation, 2));
  simulation.send_urgent(0, 1);
  run(simulation, seconds(1));
  CHECK(simulation.node(1).urgent_latency.size() == urgent + 1);
  // No nonce was used twice, nothing arrived twice.
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("what one who was forgotten had sent opens nothing any more") {
  Simulation simulation(fleet());
  std::vector<Datagram> recorded;
  simulation.on_sent = [&](std::size_t from, const Datagram& datagram) {
    if (from == 1 && !datagram.to.group) recorded.push_back(datagram);
  };
  for (const std::size_t i : {0U, 1U, 2U}) simulation.start(i);
  for (int i = 0; i < 5; ++i) {
    run(simulation, milliseconds(200));
    simulation.send_urgent(1, 0);
  }
  run(simulation, seconds(3));
  simulation.stop(1);
  simulation.stop(2);
  run(simulation, minutes(11));
  simulation.start(3);
  run(simulation, seconds(5));
  const bool was_forgotten = !knows(simulation, 2);
  const std::size_t urgent = simulation.node(0).urgent_latency.size();
  for (const Datagram& datagram : recorded) {
    simulation.inject(0, 0, simulation.node(1).addresses[0], datagram.bytes);
    run(simulation, milliseconds(20));
  }
  REQUIRE(was_forgotten);
  CHECK(!knows(simulation, 2));
  CHECK(simulation.node(0).endpoint->counts()[Unused::kNotFresh] > 0);
  CHECK(simulation.node(0).urgent_latency.size() == urgent);
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("counts of all members are summed, those of who was forgotten too") {
  Simulation simulation(fleet());
  for (const std::size_t i : {0U, 1U, 2U}) simulation.start(i);
  run(simulation, seconds(5));
  for (const std::size_t to : {1U, 2U}) {
    for (int i = 0; i < 3; ++i) simulation.send_parcel(0, to, ParcelClass::kMessage, 100);
    simulation.send_parcel(to, 0, ParcelClass::kMessage, 100);
    simulation.send_urgent(to, 0);
    simulation.set_telemetry(to, 1);
  }
  run(simulation, seconds(3));
  const auto check = [&] {
    const EndpointCounts counts = simulation.node(0).endpoint->counts();
    CHECK(counts.outbox.parcels_delivered == 6);
    CHECK(counts.outbox.parcel_bytes_sent == 600);
    CHECK(counts.inbox.parcels_delivered == 2);
    CHECK(counts.inbox.urgent_delivered == 2);
    CHECK(counts.inbox.urgent_duplicate > 0);
    CHECK(counts.inbox.telemetry_delivered == 2);
  };
  check();
  simulation.stop(1);
  simulation.stop(2);
  run(simulation, minutes(11));
  simulation.start(3);
  run(simulation, seconds(5));
  CHECK(simulation.node(0).endpoint->counts().members_forgotten == 1);
  check();
}

}  // namespace
}  // namespace warren::mesh::sim
