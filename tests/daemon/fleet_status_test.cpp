// SPDX-License-Identifier: Apache-2.0
// What the fleet's status says of nodes that are far, of maps that contradict, and of a name that
// is there twice.
#include <algorithm>

#include <doctest/doctest.h>

#include "tests/daemon/captured_log.hpp"
#include "tests/daemon/loopback_fleet.hpp"

namespace warren {
namespace {

void wait_until_logged(const CapturedLog& log, const std::string& text) {
  for (int i = 0; i < 600 && log.text().find(text) == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  CAPTURE(log.text());
  CHECK(log.text().find(text) != std::string::npos);
}

auto contradicts(const std::string& name) {
  return [name](const control::FleetStatus& status) {
    const control::FleetNode* const node = node_named(status, name);
    return node != nullptr && node->layers_size() == 1 && node->layers(0).has_conflict();
  };
}

}  // namespace

TEST_CASE("a node that others tell of is heard by its word, and not by what the store has of it") {
  Loopback fleet;
  Config base_config = fleet.config("base", 0, {2});
  base_config.store.file = fleet.file("base.db");
  std::int64_t said_us = 0;
  {
    RunningDaemon robot(fleet.config("robot-1", 1, {2}));
    RunningDaemon relay(fleet.config("robot-2", 2, {}));
    RunningDaemon base(base_config);
    take_scans(robot, 1, 2);
    const control::FleetStatus status = wait_for(base, has_all_of("robot-1"));
    const control::FleetNode& node = *node_named(status, "robot-1");
    CHECK_FALSE(node.has_link());
    CHECK(node.has_status_came_s());
    CHECK(node_named(status, "robot-2")->has_status_came_s());
    said_us = node.status_us();
    CHECK(said_us > 0);
  }
  RunningDaemon base(base_config);
  const control::FleetStatus status = fleet_status(base);
  const control::FleetNode* const node = node_named(status, "robot-1");
  REQUIRE(node != nullptr);
  CHECK(node->status_us() >= said_us);
  CHECK_FALSE(node->has_status_came_s());
  CHECK(node->layers_size() == 1);
}

TEST_CASE("who copies what is near has all when it has that") {
  Loopback fleet;
  RunningDaemon robot(fleet.config("robot-1", 1, {}));
  Config config = fleet.config("robot-2", 2, {1});
  config.share = {SharePolicyChoice::kNear, 1.0};
  config.node.fleet_T_map.x_m = 5.0;
  RunningDaemon near(config);
  take_scans(robot, 1, 2);
  take_scans(near, 1, 1);
  const control::FleetStatus status = wait_for(near, [](const control::FleetStatus& now) {
    const control::FleetNode* const node = node_named(now, "robot-1");
    return node != nullptr && node->layers_size() == 1 && node->layers(0).has_within_m() &&
           node->layers(0).latest() > 0 && node->layers(0).lag_revisions() == 0;
  });
  const control::FleetLayer& layer = node_named(status, "robot-1")->layers(0);
  CHECK(layer.within_m() == 1.0);
  CHECK(layer.held_wanted() == layer.latest());
  CHECK(layer.held_everywhere() < layer.latest());
  CHECK_FALSE(layer.has_lag_voxels());
}

TEST_CASE("a map that lies askew is told and warned of, and the own map stays as it is") {
  Loopback fleet;
  RunningDaemon robot(fleet.config("robot-1", 1, {}));
  Config config = fleet.config("robot-2", 2, {1});
  config.node.fleet_T_map.x_m = -0.5;  // its wall stands in the free space before ours
  RunningDaemon askew(config);
  RunningDaemon aligned(fleet.config("robot-3", 3, {1}));
  const CapturedLog log;
  take_scans(robot, 1, 3);
  const std::string published = settled(robot, 3).publishing().digest();
  take_scans(askew, 1, 3);
  take_scans(aligned, 1, 3);
  const double far_off =
      node_named(wait_for(robot, contradicts("robot-2")), "robot-2")->layers(0).conflict();
  CHECK(far_off > 0.25);
  const double near =
      node_named(wait_for(robot, contradicts("robot-3")), "robot-3")->layers(0).conflict();
  CHECK(near < 0.1);
  wait_until_logged(log, "a map of robot-2 contradicts this node's own");
  CHECK(log.text().find("retract it") != std::string::npos);
  CHECK(log.text().find("robot-3") == std::string::npos);
  CHECK(robot.status().publishing().digest() == published);
}

TEST_CASE("a name that another node has as well is warned of once a minute") {
  Loopback fleet;
  RunningDaemon one(fleet.config("robot-1", 1, {2}));
  RunningDaemon other(fleet.config("robot-1", 2, {1}));
  const CapturedLog log;
  const std::string warning = "another node is called robot-1 as well";
  wait_until_logged(log, warning);
  const auto packets = [](const control::FleetStatus& status) {
    return count_named(status.unused(), "own_member");
  };
  const std::uint64_t before = packets(fleet_status(one));
  wait_for(one, [&](const control::FleetStatus& now) { return packets(now) >= before + 8; });
  const std::string text = log.text();
  std::size_t lines = 0;
  for (auto at = text.find(warning); at != std::string::npos; at = text.find(warning, at + 1)) {
    ++lines;
  }
  CHECK(lines <= 2);  // one of each
}

}  // namespace warren
