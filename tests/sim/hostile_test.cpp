// SPDX-License-Identifier: Apache-2.0
// What recordings, and members that lie, cannot do.
#include <doctest/doctest.h>

#include "tests/sim/measures.hpp"
#include "transport/wire/beacon.hpp"
#include "transport/wire/envelope.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

PresharedKeys keys() { return PresharedKeys(Key{7}); }

std::vector<std::uint8_t> sealed_frame(BootId from, BootId to, std::uint64_t number,
                                       const std::vector<Frame>& frames) {
  std::vector<std::uint8_t> content;
  for (const Frame& frame : frames) append(content, frame);
  return seal(keys().pair_key(from, to), {PacketType::kPair, from, number}, content);
}

std::uint64_t sent_bytes(Simulation& simulation, std::size_t node) {
  return simulation.network().counts(static_cast<StationIndex>(node)).sent_bytes;
}

TEST_CASE("no member has the number that stands for all") {
  Simulation simulation(two_nodes());
  simulation.start(0);
  simulation.run_until(MeshTime(seconds(1)));
  const BootId self = simulation.node(0).boots.front();
  const BootId liar{99};
  const MeshAddress from = simulation.node(1).addresses[0];
  const auto beacon = encode(Beacon{{UINT32_MAX}, 1, 250, {}});
  simulation.inject(0, 0, from,
                    seal(keys().group_key(liar), {PacketType::kBeacon, liar, 0}, beacon));
  simulation.inject(0, 0, from, sealed_frame(liar, self, 0, {HelloFrame{{UINT32_MAX}, true}}));
  simulation.run_until(MeshTime(seconds(2)));
  CHECK(simulation.node(0).endpoint->counts()[Unused::kMalformed] == 2);
  CHECK(simulation.node(0).endpoint->members().empty());
  const std::vector<std::uint8_t> bytes{1};
  CHECK(simulation.node(0).endpoint->send_parcel(simulation.now(), {UINT32_MAX},
                                                 ParcelClass::kMessage, bytes) ==
        tl::unexpected(SendError::kUnknownMember));
}

TEST_CASE("nobody sends parcels to himself") {
  Simulation simulation(two_nodes());
  simulation.start(0);
  Endpoint& endpoint = *simulation.node(0).endpoint;
  const auto before = endpoint.save();
  const std::vector<std::uint8_t> bytes{1};
  CHECK(endpoint.send_parcel(simulation.now(), {1}, ParcelClass::kMessage, bytes) ==
        tl::unexpected(SendError::kUnknownMember));
  CHECK(endpoint.save() == before);
}

TEST_CASE("recorded beacons of an ended life cost next to nothing, however often they are sent") {
  Simulation::Config config = two_nodes();
  config.nodes = 3;
  Simulation simulation(config);
  std::vector<Datagram> recorded;
  simulation.on_sent = [&](std::size_t from, const Datagram& datagram) {
    if (from == 1 && datagram.to.group) recorded.push_back(datagram);
  };
  // The first life is never heard by node 0, and is no lone one: nothing in its beacons says why
  // one should hurry to answer again and again.
  simulation.start(1);
  simulation.start(2);
  simulation.run_until(MeshTime(seconds(3)));
  recorded.clear();
  simulation.run_until(MeshTime(seconds(30)));
  const std::vector<Datagram> first_life = recorded;
  REQUIRE(first_life.size() >= 20);
  simulation.stop(1);
  simulation.stop(2);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(50)));
  const MeshTime start = simulation.now();
  const std::uint64_t before = sent_bytes(simulation, 0);
  for (int i = 0; i < 20 * 60; ++i) {
    simulation.inject(0, 0, {}, first_life[static_cast<std::size_t>(i) % first_life.size()].bytes);
    simulation.run_until(start + milliseconds(50) * (i + 1));
  }
  const double bit_s = static_cast<double>(sent_bytes(simulation, 0) - before) * 8.0 / 60.0;
  MESSAGE("20 recorded beacons a second: ", bit_s, " bit/s");
  CHECK(bit_s <= 1500.0);
}

TEST_CASE("beacons that were missed and are sent an hour later bring nobody up") {
  Simulation::Config config = two_nodes();
  Simulation simulation(config);
  std::vector<Datagram> recorded;
  simulation.on_sent = [&](std::size_t from, const Datagram& datagram) {
    if (from == 1) recorded.push_back(datagram);
  };
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(5)));
  LinkConfig dead = config.networks[0].link;
  dead.loss = 1.0;
  simulation.network().set_link(simulation.now(), 1, 0, dead);
  simulation.run_until(MeshTime(seconds(6)));
  recorded.clear();  // what follows is heard by strangers only
  simulation.run_until(MeshTime(seconds(60)));
  simulation.stop(1);
  const std::vector<Datagram> missed = recorded;
  REQUIRE(missed.size() >= 20);
  simulation.run_until(MeshTime(minutes(61)));
  const std::size_t ups = simulation.node(0).members_up[2];
  const MeshTime heard = simulation.node(0).endpoint->members()[0].last_heard;
  for (const Datagram& datagram : missed) {
    if (datagram.to.group) simulation.inject(0, 0, {}, datagram.bytes);
    simulation.run_until(simulation.now() + milliseconds(200));
  }
  CHECK(simulation.node(0).members_up[2] == ups);
  CHECK(!simulation.node(0).endpoint->members()[0].up);
  CHECK(simulation.node(0).endpoint->members()[0].last_heard == heard);
  CHECK(simulation.node(0).endpoint->counts()[Unused::kNotFresh] >= 20);
}

TEST_CASE("who asks without end and acknowledges nothing gets bounded answers, and harms nobody") {
  Simulation simulation(two_nodes());
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(3)));
  const BootId self = simulation.node(0).boots.front();
  const BootId liar{99};
  const MeshTime start = simulation.now();
  std::size_t answers = 0;
  const MeshAddress nowhere{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 10, 0, 9, 9}, 7700};
  simulation.on_sent = [&](std::size_t from, const Datagram& datagram) {
    if (from == 0 && datagram.to.address == nowhere) ++answers;
  };
  constexpr int kSeconds = 120;
  for (int i = 0; i < 250 * kSeconds; ++i) {
    simulation.inject(
        0, 0, nowhere,
        sealed_frame(liar, self, static_cast<std::uint64_t>(i), {HelloFrame{{77}, true}}));
    simulation.run_until(start + milliseconds(4) * (i + 1));
  }
  MESSAGE("250 hellos a second: ", static_cast<double>(answers) / kSeconds, " packets a second");
  CHECK(answers <= 110 * kSeconds);  // 50 answers, and as many acknowledgements
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 10'000);
  CHECK(simulation.run_until(simulation.now() + seconds(2),
                             [&] { return simulation.ledger().outstanding() == 0; }));
  CHECK(simulation.ledger().failures().empty());
}

TEST_CASE("the group is served again after a short silence of all who hear it") {
  Simulation::Config config = two_nodes();
  config.interface.group_broadcast = true;
  Simulation simulation(config);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(5)));
  simulation.send_parcel(0, 1, ParcelClass::kMessage, 1'000'000);  // an answer is expected
  simulation.run_until(MeshTime(milliseconds(5500)));
  simulation.network().set_silent(simulation.now(), true);
  simulation.run_until(MeshTime(milliseconds(10'000)));
  REQUIRE(simulation.node(0).endpoint->members()[0].up);
  simulation.add_group(0, 20'000);
  simulation.run_until(MeshTime(milliseconds(10'300)));
  simulation.network().set_silent(simulation.now(), false);
  simulation.run_until(MeshTime(seconds(30)));
  CHECK(simulation.ledger().map_packets_arrived(2, MapClass::kFresh) >= 14);
  CHECK(simulation.node(0).members_up[2] == 1);
}

TEST_CASE("copies to several groups are in the budget of beacons") {
  Simulation::Config config = two_nodes();
  config.interface.group_copies = 3;
  Simulation simulation(config);
  simulation.start(0);
  simulation.start(1);
  simulation.run_until(MeshTime(seconds(20)));
  const std::uint64_t before = simulation.node(0).endpoint->counts().ip_bytes_out;
  simulation.run_until(MeshTime(seconds(120)));
  const std::uint64_t after = simulation.node(0).endpoint->counts().ip_bytes_out;
  const double bit_s = static_cast<double>(after - before) * 8.0 / 100.0;
  MESSAGE("idle, three copies of each beacon: ", bit_s, " bit/s");
  CHECK(bit_s <= 1000.0);
  CHECK(bit_s >= 400.0);
}

}  // namespace
}  // namespace warren::mesh::sim
