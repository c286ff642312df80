// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/fleet.hpp"

#include <iostream>

#include <doctest/doctest.h>

namespace warren::fleet_sim {
namespace {

using std::chrono::seconds;

FleetConfig small_fleet(std::size_t nodes, std::size_t writers) {
  FleetConfig config;
  config.mesh.nodes = nodes;
  config.mesh.check_datagrams = false;
  config.mesh.networks.front().link.capacity = Capacity(1e6);
  config.mesh.networks.front().link.delay = std::chrono::milliseconds(5);
  for (std::size_t i = 0; i < nodes; ++i) config.writes.push_back(i < writers);
  return config;
}

void run(Fleet& fleet, Duration time) { fleet.mesh().run_until(fleet.now() + time); }

TEST_CASE("what was altered in a copy is found by its digest, and pulled again") {
  Fleet fleet([] {
    auto config = small_fleet(2, 1);
    config.check = false;
    return config;
  }());
  fleet.start_all();
  run(fleet, seconds(10));
  const LayerId layer = fleet.node(0).own.back()->id();
  REQUIRE(fleet.alter(1, layer));
  run(fleet, seconds(2));
  fleet.stop_writing();
  run(fleet, seconds(40));
  CHECK(fleet.lacking() == std::nullopt);
  const auto report = fleet.node(1).replication->report(fleet.now());
  REQUIRE(report.size() == 1);
  CHECK(report[0].digests.differences == 1);
  CHECK(report[0].digests.regions == 1);
  CHECK(report[0].digests.member == MemberId{1});
}

TEST_CASE("a report says who lacks what, and since when") {
  Fleet fleet(small_fleet(3, 1));
  fleet.start_all();
  run(fleet, seconds(20));
  const auto level = fleet.node(0).replication->report(fleet.now());
  REQUIRE(level.size() == 1);
  REQUIRE(level[0].peers.size() == 2);
  CHECK(level[0].peers[0].lag_revisions <= 1);
  fleet.crash(2);
  run(fleet, seconds(20));
  const auto apart = fleet.node(0).replication->report(fleet.now());
  CHECK(apart[0].peers[0].lag_revisions <= 1);
  const auto& lag = apart[0].peers[1];
  CHECK(lag.lag_revisions >= 15);
  CHECK(lag.lag_voxels > 0);
  CHECK(lag.behind > seconds(15));
  CHECK(lag.behind < seconds(25));
  fleet.stop_writing();
  fleet.start(2);
  run(fleet, seconds(30));
  const auto again = fleet.node(0).replication->report(fleet.now());
  CHECK(again[0].peers[1].lag_revisions == 0);
  CHECK(again[0].peers[1].digest_equal == true);
}

TEST_CASE("who wants what is near has that, and not the rest") {
  auto config = small_fleet(2, 1);
  config.shares = {{}, {replication::Share::kNear, 8.0}};
  config.walker.blocks_per_step = 6;
  Fleet fleet(config);
  fleet.start_all();
  run(fleet, seconds(60));
  fleet.stop_writing();
  run(fleet, seconds(10));
  const Replica& layer = *fleet.node(0).own.back();
  const auto& replication = *fleet.node(1).replication;
  const auto* const copy = replication.book().find(layer.id());
  REQUIRE(copy != nullptr);
  const auto& keys = replication.pull_of(layer.id())->keys;
  REQUIRE(!keys.intervals.empty());
  for (const KeyInterval& interval : keys.intervals) {
    CHECK(copy->replica().holdings().lowest(interval) == layer.holdings().at(0));
  }
  CHECK(copy->replica().holdings().lowest({}) == Revision{});
  CHECK(fleet.failures().empty());
}

TEST_CASE("nobody is told the same by two, but for a moment when the way changes") {
  auto config = small_fleet(5, 2);
  config.mesh.networks.front().link.loss = 0.0;
  Fleet fleet(config);
  for (std::size_t i = 0; i < 4; ++i) fleet.start(i);
  run(fleet, seconds(30));
  CHECK(fleet.packets().applied > 100);
  CHECK(fleet.packets().duplicate == 0);
  // One comes late, and finds four that have everything. When it hears a writer itself after
  // another, what is on its way from that one comes twice.
  fleet.start(4);
  run(fleet, seconds(10));
  const auto settled = fleet.packets();
  run(fleet, seconds(20));
  CHECK(fleet.packets().applied > settled.applied + 50);
  CHECK(fleet.packets().duplicate == settled.duplicate);
  // One that passes everything on is gone, and one of the writers.
  fleet.crash(2);
  run(fleet, seconds(20));
  fleet.crash(0);
  run(fleet, seconds(20));
  fleet.start(0);
  fleet.start(2);
  run(fleet, seconds(30));
  fleet.stop_writing();
  run(fleet, seconds(10));
  CHECK(fleet.lacking() == std::nullopt);
  const auto packets = fleet.packets();
  CHECK(packets.duplicate < packets.applied / 20);
  CHECK(fleet.failures().empty());
}

TEST_CASE("who hears the writer badly gets its map from one who hears it well") {
  for (const double loss : {0.7, 0.85}) {
    Fleet fleet(small_fleet(3, 1));
    LinkConfig bad;
    bad.capacity = Capacity(1e6);
    bad.delay = std::chrono::milliseconds(5);
    bad.loss = loss;
    fleet.mesh().network().set_link(fleet.now(), 0, 2, bad);
    fleet.mesh().network().set_link(fleet.now(), 2, 0, bad);
    fleet.start_all();
    run(fleet, seconds(60));
    std::uint32_t most = 0;
    std::uint64_t behind = 0;
    for (int i = 0; i < 240; ++i) {
      run(fleet, std::chrono::milliseconds(500));
      const Replica& layer = *fleet.node(0).own.back();
      const auto* const copy = fleet.node(2).replication->book().find(layer.id());
      REQUIRE(copy != nullptr);
      const std::uint32_t lag =
          layer.holdings().at(0).number - copy->replica().holdings().lowest({}).number;
      most = std::max(most, lag);
      behind += lag > 1 ? 1 : 0;
    }
    const auto& reader = *fleet.node(2).replication;
    CHECK(reader.pull_of(fleet.node(0).own.back()->id())->provider == MemberId{2});
    CHECK(behind == 0);
    CHECK(most <= 1);
  }
}

TEST_CASE("thirty that agree say nothing") {
  auto config = small_fleet(30, 3);
  config.check = false;
  config.mesh.networks.front().shared_airtime = true;
  config.mesh.networks.front().link.capacity = Capacity(10e6);
  config.tick = seconds(5);
  Fleet fleet(config);
  fleet.start_all();
  run(fleet, seconds(10));
  fleet.stop_writing();
  run(fleet, seconds(60));
  CHECK(fleet.lacking() == std::nullopt);
  const std::uint64_t before = fleet.said_bytes();
  run(fleet, seconds(60));
  CHECK(fleet.said_bytes() == before);
}

TEST_CASE("a message to one that is never met goes through others, and its receipt comes back") {
  Fleet fleet(small_fleet(3, 0));
  LinkConfig dead;
  dead.loss = 1.0;
  fleet.mesh().network().set_link(fleet.now(), 0, 2, dead);
  fleet.mesh().network().set_link(fleet.now(), 2, 0, dead);
  fleet.start_all();
  run(fleet, seconds(5));
  REQUIRE(fleet.post(0, 2, 100));
  REQUIRE(fleet.post(0, std::nullopt, 100));
  run(fleet, seconds(20));
  CHECK(fleet.undelivered() == std::nullopt);
  auto& book = fleet.node(0).replication->log_book();
  CHECK(book.own()->log.find(0) == nullptr);
  CHECK(book.own()->log.find(1) != nullptr);
  auto& relay = fleet.node(1).replication->log_book();
  CHECK(relay.find(book.own()->log.id())->log.find(0) == nullptr);
}

}  // namespace
}  // namespace warren::fleet_sim
