// SPDX-License-Identifier: Apache-2.0
// What a node has no room for, and how it tells of that.
#include <array>
#include <chrono>
#include <set>

#include <asio/io_context.hpp>
#include <doctest/doctest.h>

#include "daemon/control/response.hpp"
#include "daemon/fleet/no_store.hpp"
#include "daemon/fleet_setup.hpp"
#include "daemon/log.hpp"
#include "tests/daemon/loopback_fleet.hpp"
#include "tests/daemon/small_fleet.hpp"

namespace warren {
namespace {

struct Node {
  Node(asio::io_context& io, const FleetConfig& config)
      : store(io), map(config.map, [] { return 1; }), mesh(io, config.mesh, map, store) {
    set_log_level(LogLevel::kOff);
    map.on_open([this](const OwnLayer& layer) { mesh.on_opened(layer); });
    mesh.start();
    const std::vector<LayerChanges> changes{test::changes_of({test::floor_block({0, 0, 0}, 1)})};
    map.tick(changes);
    mesh.on_ticked({});
  }
  FleetRefusedCounts refused() { return mesh.report().refused; }

  NoStore store;
  FleetMap map;
  FleetMesh mesh;
};

template <typename Condition>
void run_until(asio::io_context& io, const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!condition() && std::chrono::steady_clock::now() < end) io.run_one_until(end);
  CHECK(condition());
}

replication::StoredLog log_with_status(std::uint32_t origin) {
  replication::Item item;
  item.kind = replication::ItemKind::kStatus;
  item.bytes = encode(NodeStatus{"robot", NodeRole::kRobot, 1, std::nullopt, std::nullopt});
  replication::StoredLog log;
  log.id = {origin, 1};
  log.seen.add({0, 1});
  log.items[0] = item;
  return log;
}

}  // namespace

TEST_CASE("layers and logs beyond those that a node holds are counted") {
  Loopback loopback;
  asio::io_context io;
  FleetConfig config = fleet_config_of(loopback.config("robot-1", 1, {})).value();
  config.mesh.replication.layers.layers_max = 1;
  config.mesh.replication.logs_max = 1;
  Node full(io, config);
  Node other(io, fleet_config_of(loopback.config("robot-2", 2, {1})).value());
  run_until(io, [&] { return full.refused().layers > 0 && full.refused().logs > 0; });
  CHECK(full.refused().log_messages > 0);
  run_until(io, [&] { return other.mesh.report().nodes.front().layers.size() == 1; });
  CHECK(other.refused().layers == 0);
}

TEST_CASE("packets of a layer that there is no memory for are counted") {
  Loopback loopback;
  asio::io_context io;
  FleetConfig config = fleet_config_of(loopback.config("robot-1", 1, {})).value();
  config.mesh.replication.layers.copies_bytes_max = 0;
  Node full(io, config);
  const Node other(io, fleet_config_of(loopback.config("robot-2", 2, {1})).value());
  run_until(io, [&] { return full.refused().packets_without_room > 0; });
}

TEST_CASE("nodes beyond those that are known are counted") {
  set_log_level(LogLevel::kOff);
  asio::io_context io;
  FleetConfig config = fleet_config_of(Config{}).value();
  config.mesh.replication.logs_max = replication::kSlotsMax;
  NoStore store(io);
  FleetMap map(config.map, [] { return 1; });
  FleetMesh mesh(io, config.mesh, map, store);
  StoredFleet stored;
  for (std::uint32_t i = 1; i <= NodeBook::kNodesMax + 3; ++i) {
    stored.logs.push_back(log_with_status(i));
  }
  mesh.restore(std::move(stored));
  CHECK(mesh.report().refused.statuses_without_room == 3);
}

TEST_CASE("every count of what was not taken is told under a name of its own") {
  FleetReport report;
  FleetRefusedCounts& refused = report.refused;
  replication::RefusedCounts& by_replication = refused.replication;
  const std::array counts{&by_replication.malformed_announcements,
                          &by_replication.changed_slots,
                          &by_replication.malformed_messages,
                          &by_replication.unknown_slots,
                          &by_replication.other_resolution,
                          &by_replication.stale_wishes,
                          &by_replication.gaps,
                          &by_replication.wishes_for_lost,
                          &by_replication.peers_refused,
                          &refused.layers,
                          &refused.packets_without_room,
                          &refused.packets_for_own_layers,
                          &refused.logs,
                          &refused.log_messages,
                          &refused.own_items,
                          &refused.items_dropped,
                          &refused.digests.differences,
                          &refused.digests.regions,
                          &refused.digests.given_up,
                          &refused.telemetry,
                          &refused.copies,
                          &refused.unknown_statuses,
                          &refused.statuses_without_room,
                          &refused.messages_unreadable,
                          &refused.messages_dropped,
                          &refused.orders_refused,
                          &refused.orders_unauthorised};
  std::set<std::uint64_t> expected;
  for (std::size_t i = 0; i < counts.size(); ++i) expected.insert(*counts[i] = i + 1);
  control::Response response;
  REQUIRE(response.ParseFromString(encode_fleet_status(report).substr(4)));
  std::set<std::uint64_t> told;
  std::set<std::string> names;
  for (const control::Count& count : response.fleet_status().refused()) {
    told.insert(count.count());
    names.insert(count.name());
  }
  CHECK(told == expected);
  CHECK(names.size() == counts.size());
  CHECK(count_named(response.fleet_status().refused(), "repairs_given_up") ==
        refused.digests.given_up);
}

}  // namespace warren
