// SPDX-License-Identifier: Apache-2.0
// Whole daemons that share their maps over the loopback interface.
#include <algorithm>

#include <doctest/doctest.h>

#include "core/exchange/layer_file.hpp"
#include "core/layer/hash_text.hpp"
#include "tests/daemon/loopback_fleet.hpp"
#include "tests/daemon/running_daemon.hpp"
#include "tests/daemon/test_client.hpp"

namespace warren {

TEST_CASE("a base copies what a robot maps, merges it, and saves it by the robot's name") {
  Loopback fleet;
  Config robot_config = fleet.config("robot-1", 1, {});
  robot_config.node.fleet_T_map.x_m = 100.0;
  RunningDaemon robot(robot_config);
  RunningDaemon base(fleet.config("base", 0, {1}));
  CHECK_FALSE(std::filesystem::exists(base.ingest_socket()));
  take_scans(robot, 1, 3);
  const control::Publishing published = settled(robot, 3).publishing();
  const control::FleetStatus status = wait_for(base, [&](const control::FleetStatus& now) {
    return has_all_of("robot-1")(now) &&
           node_named(now, "robot-1")->layers(0).latest() == published.revision();
  });
  CHECK(status.nodes(0).is_self());
  CHECK(status.nodes(0).role() == "base");
  const control::FleetNode& heard = *node_named(status, "robot-1");
  CHECK(heard.role() == "robot");
  CHECK(heard.link().up());
  CHECK(heard.link().interface() == "lo");
  CHECK(heard.link().received().fresh_bytes() + heard.link().received().backlog_bytes() > 0);
  CHECK(heard.layers(0).up_to_us() > 0);
  CHECK(heard.layers(0).hops() == 1);
  CHECK(heard.position_fleet_m(0) == doctest::Approx(100.0));

  TestClient client(base.control_socket());
  control::Request save;
  save.mutable_map_save()->set_path(fleet.file("copy.layer").string());
  save.mutable_map_save()->set_of("robot-1");
  REQUIRE(client.ask(save).has_map_saved());
  const auto copy = read_layer(fleet.file("copy.layer"));
  REQUIRE(copy.has_value());
  CHECK(hex_of(copy->digest().root()) == published.digest());
  save.mutable_map_save()->set_path(fleet.file("copy.ply").string());
  CHECK(client.ask(save).map_saved().voxels() > 0);
  save.mutable_map_save()->set_of("robot-9");
  CHECK(client.ask(save).error().text().find("robot-9") != std::string::npos);

  // The wall that the robot sees 5 m ahead, where its surveyed start puts it.
  control::Request cell;
  for (const double coordinate : {105.05, 0.05, 0.05})
    cell.mutable_cells()->add_low_map_m(coordinate);
  cell.mutable_cells()->set_source(control::MERGE);
  REQUIRE(client.ask(cell).cells().cells_size() == 1);
  CHECK(client.ask(cell).cells().cells(0).state() == "occupied");
  control::Request retract;
  *retract.mutable_map_retract()->mutable_layer() = heard.layers(0).layer();
  CHECK(client.ask(retract).loaded_layer().retracted());
  CHECK(client.ask(cell).cells().cells(0).state() == "unknown");
  CHECK(node_named(fleet_status(base), "robot-1")->layers(0).retracted());
}

TEST_CASE("robots that never meet have each other's maps through one that meets both") {
  Loopback fleet;
  RunningDaemon left(fleet.config("robot-1", 1, {2}));
  RunningDaemon middle(fleet.config("robot-2", 2, {}));
  RunningDaemon right(fleet.config("robot-3", 3, {2}));
  take_scans(left, 1, 2);
  take_scans(right, 1, 4);
  wait_for(left, has_all_of("robot-3"));
  const control::FleetStatus status = wait_for(right, has_all_of("robot-1"));
  CHECK_FALSE(node_named(status, "robot-1")->has_link());
  CHECK(node_named(status, "robot-1")->layers(0).hops() == 2);
  CHECK(node_named(status, "robot-1")->layers(0).provider() == "robot-2");
}

TEST_CASE("what is published at shutdown is with the neighbours when the daemon has ended") {
  Loopback fleet;
  RunningDaemon base(fleet.config("base", 0, {1}));
  Config config = fleet.config("robot-1", 1, {0});
  config.layer.hold_ragged_free = true;
  config.layer.flush_after_s = 3600.0;
  config.mesh.shutdown_s = 20.0;
  {
    RunningDaemon robot(config);
    take_scans(robot, 1, 3);
    wait_for(base, [](const control::FleetStatus& status) {
      const auto* const node = node_named(status, "robot-1");
      return node != nullptr && node->layers_size() == 1;
    });
    robot.request_stop();
    robot.join();
  }
  wait_for(base, has_all_of("robot-1"));
}

TEST_CASE("a node with another key is nobody") {
  Loopback fleet;
  Loopback strangers;
  RunningDaemon robot(fleet.config("robot-1", 1, {2}));
  RunningDaemon stranger(strangers.config("robot-2", 2, {1}));
  take_scans(robot, 1, 1);
  const control::FleetStatus status = wait_for(stranger, [](const control::FleetStatus& now) {
    return std::any_of(now.unused().begin(), now.unused().end(), [](const control::Count& count) {
      return count.name() == "not_authentic" && count.count() > 0;
    });
  });
  CHECK(status.nodes_size() == 1);
}

TEST_CASE("without an interface the mesh is off, and a missing key is told at the start") {
  RunningDaemon alone;
  CHECK_FALSE(fleet_status(alone).mesh_on());
  Loopback fleet;
  Config config = fleet.config("robot-1", 1, {});
  config.mesh.key_file = fleet.file("nowhere.key");
  config.sockets.control.path = fleet.file("c.sock");
  config.sockets.ingest.path = fleet.file("i.sock");
  asio::io_context io;
  const auto started = Warrend::start(io, config, fleet.file("robot.yaml"), {save_map});
  REQUIRE_FALSE(started.has_value());
  CHECK(started.error().find("warrenctl key new") != std::string::npos);
}

}  // namespace warren
