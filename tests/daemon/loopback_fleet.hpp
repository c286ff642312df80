// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <unistd.h>

#include "daemon/key_file.hpp"
#include "tests/daemon/frames.hpp"
#include "tests/daemon/running_daemon.hpp"
#include "tests/daemon/test_client.hpp"
#include "transport/udp/address_text.hpp"

namespace warren {

// Ports of our own, so that test processes that run at once do not meet.
inline std::uint32_t port_of(std::uint32_t node) {
  return 10'000 + static_cast<std::uint32_t>(getpid()) % 2500 * 8 + node;
}

// A fleet on this host: no group, nodes are sought by address.
class Loopback {
 public:
  Loopback() { REQUIRE(make_key_file(directory_ / "fleet.key").has_value()); }

  Config config(const std::string& name, std::uint32_t node,
                const std::vector<std::uint32_t>& seeks) {
    Config config = name == "base" ? Config::of_base() : Config{};
    config.node.name = name;
    config.layer.tick_s = 0.1;
    config.layer.flush_after_s = 0.1;
    config.mesh.key_file = directory_ / "fleet.key";
    config.mesh.port = port_of(node);
    config.mesh.group_port = port_of(4 + node);  // nobody else's
    MeshInterfaceConfig interface;
    interface.name = "lo";
    for (const std::uint32_t seed : seeks) {
      interface.seeds.push_back(
          *mesh::parse_mesh_address("127.0.0.1:" + std::to_string(port_of(seed))));
    }
    config.mesh.interfaces = {interface};
    return config;
  }
  std::filesystem::path file(const std::string& name) const { return directory_ / name; }

 private:
  TemporaryDirectory directory_;
};

// Of a wall of so many points, which is the same every time.
inline void take_scans(const RunningDaemon& daemon, std::uint64_t first, std::uint64_t count,
                       std::size_t points = 1024) {
  TestClient client = greeted_client(daemon.ingest_socket());
  for (std::uint64_t i = first; i < first + count; ++i) {
    REQUIRE(client.write(scan_frame(i, points)));
    REQUIRE(client.read_receipt().outcome() == ingest::ScanReceipt::TAKEN);
  }
}

// What the daemon tells when so many scans are in its map and all they changed is published.
inline control::Status settled(const RunningDaemon& daemon, std::uint64_t scans) {
  control::Status status;
  std::optional<std::uint64_t> ticks_by_then;
  for (int i = 0; i < 600; ++i) {
    status = daemon.status();
    const control::Publishing& now = status.publishing();
    if (!ticks_by_then && status.map().scans() >= scans) ticks_by_then = now.ticks();
    // The first tick after may have begun before.
    const bool done = ticks_by_then && now.ticks() >= *ticks_by_then + 2 && now.revision() > 0 &&
                      now.blocks_held_back() == 0;
    if (done) return status;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  FAIL("nothing settled: ", status.DebugString());
  return status;
}

inline control::FleetStatus fleet_status(const RunningDaemon& daemon) {
  control::Request request;
  request.mutable_fleet_status();
  return TestClient(daemon.control_socket()).ask(request).fleet_status();
}

// Asks again until the condition holds, for at most half a minute.
template <typename Condition>
control::FleetStatus wait_for(const RunningDaemon& daemon, const Condition& condition) {
  control::FleetStatus status;
  for (int i = 0; i < 600; ++i) {
    status = fleet_status(daemon);
    if (condition(status)) return status;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  FAIL("waited in vain: ", status.DebugString());
  return status;
}

inline const control::FleetNode* node_named(const control::FleetStatus& status,
                                            const std::string& name) {
  const auto found = std::find_if(status.nodes().begin(), status.nodes().end(),
                                  [&](const auto& node) { return node.name() == name; });
  return found == status.nodes().end() ? nullptr : &*found;
}

inline auto has_all_of(const std::string& name) {
  return [name](const control::FleetStatus& status) {
    const control::FleetNode* const node = node_named(status, name);
    return node != nullptr && node->layers_size() == 1 && node->layers(0).latest() > 0 &&
           node->layers(0).lag_revisions() == 0 && node->layers(0).digest_equal() &&
           !node->layers(0).unplaced();
  };
}

}  // namespace warren
