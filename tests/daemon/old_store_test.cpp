// SPDX-License-Identifier: Apache-2.0
// Whole daemons whose store was put back from an older copy.
#include <algorithm>
#include <filesystem>

#include <doctest/doctest.h>

#include "tests/daemon/loopback_fleet.hpp"

namespace warren {

TEST_CASE("a store that is put back from an older copy ends its layer, and the node goes on") {
  Loopback fleet;
  Config config = fleet.config("robot-1", 1, {});
  config.store.file = fleet.file("robot.db");
  RunningDaemon base(fleet.config("base", 0, {1}));
  // The revision that the base has then.
  const auto map_on = [&](std::uint64_t first, std::size_t points) {
    RunningDaemon robot(config);
    take_scans(robot, first, 2, points);
    const std::uint32_t published = settled(robot, first + 1).publishing().revision();
    wait_for(base, [&](const control::FleetStatus& status) {
      return has_all_of("robot-1")(status) &&
             node_named(status, "robot-1")->layers(0).held_everywhere() == published;
    });
    return published;
  };
  const std::uint32_t stored = map_on(1, 128);
  std::filesystem::copy_file(fleet.file("robot.db"), fleet.file("old.db"));
  const std::uint32_t lost = map_on(3, 2048);
  REQUIRE(lost > stored);
  std::filesystem::copy_file(fleet.file("old.db"), fleet.file("robot.db"),
                             std::filesystem::copy_options::overwrite_existing);
  const auto has_both = [&](const control::FleetStatus& status) {
    const control::FleetNode* const node = node_named(status, "robot-1");
    const auto is_good = [&](const control::FleetLayer& layer) {
      return layer.layer().number() == 0 ? layer.held_everywhere() == lost
                                         : layer.latest() > 0 && layer.lag_revisions() == 0;
    };
    return node != nullptr && node->layers_size() == 2 &&
           std::all_of(node->layers().begin(), node->layers().end(), is_good);
  };
  {
    RunningDaemon robot(config);
    // What was measured up to then stays, in a new layer.
    CHECK(robot.status().map().scans() == 2);
    take_scans(robot, 5, 2);
    const control::Status status = settled(robot, 4);
    CHECK(status.publishing().layer().number() == 1);
    CHECK(status.map().scans() == 4);
    CHECK(status.map().layers() == 1);
    // The base has the new layer, and the robot gets back from it what it lost of the old one.
    wait_for(base, has_both);
    CHECK(wait_for(robot, has_both).batches_failed() == 0);
  }
  const RunningDaemon again(config);
  wait_for(again, has_both);
}

TEST_CASE("a robot whose store was put back from a copy hears of it, and begins a new layer") {
  Loopback fleet;
  Config config = fleet.config("robot-1", 1, {});
  config.store.file = fleet.file("robot.db");
  const auto copy = [&](const std::string& from, const std::string& to) {
    for (const std::string& ending : {std::string(".db"), std::string(".db-commits")}) {
      std::filesystem::copy_file(fleet.file(from + ending), fleet.file(to + ending),
                                 std::filesystem::copy_options::overwrite_existing);
    }
  };
  {
    RunningDaemon robot(config);
    take_scans(robot, 1, 1, 64);
    (void)settled(robot, 1);
  }
  copy("robot", "kept");
  RunningDaemon base(fleet.config("base", 0, {1}));
  {
    RunningDaemon robot(config);
    take_scans(robot, 2, 3);
    (void)settled(robot, 4);
    wait_for(base, has_all_of("robot-1"));
  }
  copy("kept", "robot");
  {
    RunningDaemon robot(config);
    wait_for(robot, [](const control::FleetStatus& status) {
      const control::FleetNode* const node = node_named(status, "robot-1");
      return node != nullptr && node->layers_size() == 1 && node->layers(0).behind();
    });
  }
  RunningDaemon robot(config);
  take_scans(robot, 5, 3);
  wait_for(base, [](const control::FleetStatus& status) {
    const control::FleetNode* const node = node_named(status, "robot-1");
    return node != nullptr &&
           std::any_of(node->layers().begin(), node->layers().end(), [](const auto& layer) {
             return layer.layer().number() == 1 && layer.latest() > 0 && layer.digest_equal() &&
                    !layer.unplaced();
           });
  });
}

}  // namespace warren
