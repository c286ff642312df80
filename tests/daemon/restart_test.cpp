// SPDX-License-Identifier: Apache-2.0
// Whole daemons that end and start again on the same store.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <asio/io_context.hpp>
#include <doctest/doctest.h>

#include "core/exchange/layer_file.hpp"
#include "core/layer/hash_text.hpp"
#include "tests/daemon/loopback_fleet.hpp"

namespace warren {
namespace {

bool same_layer(const control::LayerId& a, const control::LayerId& b) {
  return a.SerializeAsString() == b.SerializeAsString();
}

Config quick(const Loopback& fleet) {
  Config config;
  config.layer.tick_s = 0.1;
  config.layer.flush_after_s = 0.1;
  config.store.file = fleet.file("robot.db");
  return config;
}

std::string digest_of_copy(const RunningDaemon& daemon, const std::string& of,
                           const std::filesystem::path& file) {
  control::Request save;
  save.mutable_map_save()->set_path(file.string());
  save.mutable_map_save()->set_of(of);
  REQUIRE(TestClient(daemon.control_socket()).ask(save).has_map_saved());
  const auto copy = read_layer(file);
  REQUIRE(copy.has_value());
  return hex_of(copy->digest().root());
}

}  // namespace

TEST_CASE("a robot that starts again goes on with its map and its layer") {
  Loopback fleet;
  control::Status before;
  {
    RunningDaemon robot(quick(fleet));
    take_scans(robot, 1, 3);
    before = settled(robot, 3);
  }
  RunningDaemon robot(quick(fleet));
  const control::Status after = settled(robot, 3);
  CHECK(after.map().scans() == 3);
  CHECK(after.map().voxels_free() == before.map().voxels_free());
  CHECK(after.map().voxels_occupied() == before.map().voxels_occupied());
  CHECK(after.map().layers() == 1);
  CHECK(same_layer(after.publishing().layer(), before.publishing().layer()));
  CHECK(after.publishing().digest() == before.publishing().digest());
  CHECK(after.publishing().revision() == before.publishing().revision());
  take_scans(robot, 4, 1);
  CHECK(robot.status().map().scans() == 4);
  CHECK(robot.status().map().layers() == 1);
}

TEST_CASE("a base that starts again has the maps of robots that are gone, and their word") {
  Loopback fleet;
  Config base_config = fleet.config("base", 0, {1});
  base_config.store.file = fleet.file("base.db");
  std::string digest;
  {
    RunningDaemon base(base_config);
    RunningDaemon robot(fleet.config("robot-1", 1, {}));
    take_scans(robot, 1, 2);
    digest = settled(robot, 2).publishing().digest();
    wait_for(base, has_all_of("robot-1"));
  }
  RunningDaemon base(base_config);
  const control::FleetStatus status = wait_for(base, has_all_of("robot-1"));
  CHECK_FALSE(node_named(status, "robot-1")->has_link());
  CHECK(count_named(status.lifetime(), "starts") == 2);
  CHECK(count_named(status.lifetime(), "packets_in") > status.packets_in());
  CHECK(digest_of_copy(base, "robot-1", fleet.file("copy.layer")) == digest);
}

TEST_CASE("after a restart a robot's layer goes on at its neighbours, from where it was") {
  Loopback fleet;
  Config config = fleet.config("robot-1", 1, {});
  config.store.file = fleet.file("robot.db");
  RunningDaemon base(fleet.config("base", 0, {1}));
  {
    RunningDaemon robot(config);
    take_scans(robot, 1, 2, 512);
    wait_for(base, has_all_of("robot-1"));
  }
  RunningDaemon robot(config);
  const std::uint32_t before = settled(robot, 2).publishing().revision();
  take_scans(robot, 3, 3);
  wait_for(base, [&](const control::FleetStatus& status) {
    return has_all_of("robot-1")(status) &&
           node_named(status, "robot-1")->layers(0).latest() > before;
  });
}

TEST_CASE("with another resolution a new layer is begun, and the old one is kept and shared") {
  Loopback fleet;
  Config config = fleet.config("robot-1", 1, {});
  config.store.file = fleet.file("robot.db");
  {
    RunningDaemon robot(config);
    take_scans(robot, 1, 2);
    settled(robot, 2);
  }
  config.map.resolution_m = 0.2;
  RunningDaemon robot(config);
  CHECK(robot.status().map().scans() == 0);
  take_scans(robot, 1, 2);
  CHECK(settled(robot, 2).publishing().layer().number() == 1);
  RunningDaemon base(fleet.config("base", 0, {1}));
  wait_for(base, [](const control::FleetStatus& status) {
    const auto* const node = node_named(status, "robot-1");
    return node != nullptr && node->layers_size() == 2 && node->layers(0).lag_revisions() == 0 &&
           node->layers(1).lag_revisions() == 0 && node->layers(0).latest() > 0 &&
           node->layers(1).latest() > 0;
  });
}

TEST_CASE("a damaged store is moved aside, and the node begins anew") {
  Loopback fleet;
  {
    RunningDaemon robot(quick(fleet));
    take_scans(robot, 1, 1);
    settled(robot, 1);
  }
  std::fstream file(fleet.file("robot.db"), std::ios::in | std::ios::out | std::ios::binary);
  for (int page = 0; page < 3; ++page) {
    file.seekp(4096 * page + 100);
    file.write("damage damage damage damage damage", 34);
  }
  file.close();
  RunningDaemon robot(quick(fleet));
  CHECK(robot.status().map().scans() == 0);
  CHECK(std::filesystem::exists(fleet.file("robot.db.corrupt-1")));
  take_scans(robot, 1, 1);
  CHECK(settled(robot, 1).map().scans() == 1);
}

TEST_CASE("two daemons cannot have one store, and a folder that is missing is named") {
  Loopback fleet;
  RunningDaemon robot(quick(fleet));
  const auto refusal = [&](Config config) {
    config.sockets.control.path = fleet.file("c.sock");
    config.sockets.ingest.path = fleet.file("i.sock");
    asio::io_context io;
    const auto started = Warrend::start(io, config, fleet.file("robot.yaml"), {save_map});
    REQUIRE_FALSE(started.has_value());
    return started.error();
  };
  CHECK(refusal(quick(fleet)).find("robot.db") != std::string::npos);
  Config nowhere = quick(fleet);
  nowhere.store.file = fleet.file("nowhere/robot.db");
  CHECK(refusal(nowhere).find("nowhere") != std::string::npos);
}

TEST_CASE("without a store a restart begins anew, under another layer") {
  Loopback fleet;
  Config config = quick(fleet);
  config.store.enabled = false;
  control::LayerId before;
  {
    RunningDaemon robot(config);
    take_scans(robot, 1, 1);
    before = settled(robot, 1).publishing().layer();
    CHECK_FALSE(robot.status().has_store());
  }
  RunningDaemon robot(config);
  take_scans(robot, 1, 1);
  CHECK_FALSE(same_layer(settled(robot, 1).publishing().layer(), before));
  CHECK_FALSE(std::filesystem::exists(config.store.file));
}

TEST_CASE("a second base, and one that lost its disk, catch up from a robot of another's map") {
  Loopback fleet;
  Config base_config = fleet.config("base", 0, {1, 2});
  base_config.store.file = fleet.file("base.db");
  RunningDaemon relay(fleet.config("robot-2", 2, {1}));
  std::string digest;
  {
    RunningDaemon base(base_config);
    RunningDaemon robot(fleet.config("robot-1", 1, {}));
    take_scans(robot, 1, 2);
    digest = settled(robot, 2).publishing().digest();
    wait_for(base, has_all_of("robot-1"));
    wait_for(relay, has_all_of("robot-1"));
  }
  // The writer is gone for good, and so is the base's disk.
  for (const auto& entry :
       std::filesystem::directory_iterator(fleet.file("base.db").parent_path())) {
    if (entry.path().filename().string().starts_with("base.db")) std::filesystem::remove(entry);
  }
  base_config.mesh.interfaces[0].seeds = fleet.config("base", 0, {2}).mesh.interfaces[0].seeds;
  Config second_config = fleet.config("base", 3, {2});
  second_config.node.name = "base-2";
  const RunningDaemon base(base_config);
  const RunningDaemon second(second_config);
  for (const RunningDaemon* late : {&base, &second}) {
    wait_for(*late, has_all_of("robot-1"));
    CHECK(digest_of_copy(*late, "robot-1", fleet.file("copy.layer")) == digest);
  }
}

}  // namespace warren
