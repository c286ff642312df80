// SPDX-License-Identifier: Apache-2.0
// Messages, orders of the operator and paths, between whole daemons.
#include <cmath>
#include <functional>

#include <doctest/doctest.h>

#include "tests/daemon/loopback_fleet.hpp"

namespace warren {

namespace {

control::Response ask(const RunningDaemon& daemon, const control::Request& request) {
  return TestClient(daemon.control_socket()).ask(request);
}

// Asks again until the answer will do, for at most half a minute.
control::Response wait_for_answer(const RunningDaemon& daemon, const control::Request& request,
                                  const std::function<bool(const control::Response&)>& will_do) {
  control::Response response;
  for (int i = 0; i < 600; ++i) {
    response = ask(daemon, request);
    if (will_do(response)) return response;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  FAIL("waited in vain: ", response.ShortDebugString());
  return response;
}

control::Request message_to(const std::string& to, const std::string& content) {
  control::Request request;
  request.mutable_message_send()->set_to(to);
  request.mutable_message_send()->set_content(content);
  return request;
}

bool is_accepted(const control::Response& response) { return response.has_message_accepted(); }

// The inbox as soon as all of these are in it.
control::Messages received(const RunningDaemon& daemon, const std::vector<std::string>& contents) {
  control::Request request;
  request.mutable_message_watch();
  const auto has_all = [&](const control::Response& response) {
    const auto& came = response.messages().messages();
    return std::all_of(contents.begin(), contents.end(), [&](const std::string& content) {
      return std::any_of(came.begin(), came.end(),
                         [&](const auto& message) { return message.content() == content; });
    });
  };
  return wait_for_answer(daemon, request, has_all).messages();
}

control::Request order_on(const std::string& node, control::FleetOrderRequest::What what) {
  control::Request request;
  request.mutable_fleet_order()->set_what(what);
  request.mutable_fleet_order()->set_node(node);
  return request;
}

// What the merge-map knows of the place, which has no own layers below it: in the fleet frame.
std::string state_at(const RunningDaemon& daemon, double x_m) {
  control::Request request;
  for (const double coordinate : {x_m, 0.05, 0.05}) {
    request.mutable_cells()->add_low_map_m(coordinate);
  }
  request.mutable_cells()->set_source(control::MERGE);
  const control::Response response = ask(daemon, request);
  REQUIRE(response.cells().cells_size() == 1);
  return response.cells().cells(0).state();
}

void wait_for_state(const RunningDaemon& daemon, double x_m, const std::string& state) {
  for (int i = 0; i < 600 && state_at(daemon, x_m) != state; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  CHECK(state_at(daemon, x_m) == state);
}

auto layers_retracted(const std::string& name, bool retracted) {
  return [name, retracted](const control::FleetStatus& status) {
    const control::FleetNode* const node = node_named(status, name);
    return node != nullptr && node->layers_size() == 1 &&
           node->layers(0).retracted_by_fleet() == retracted;
  };
}

// robot-1 maps a wall at x = 105.05 m of the fleet frame; robot-2 hears it and the base, who do not
// hear each other.
struct RelayedFleet {
  Loopback loopback;
  RunningDaemon robot;
  RunningDaemon relay;
  RunningDaemon base;

  RelayedFleet()
      : robot(robot_config(loopback)),
        relay(loopback.config("robot-2", 2, {})),
        base(loopback.config("base", 0, {2})) {}
  static Config robot_config(Loopback& loopback) {
    Config config = loopback.config("robot-1", 1, {2});
    config.node.fleet_T_map.x_m = 100.0;
    return config;
  }
};

}  // namespace

TEST_CASE("messages reach nodes that the sender never hears, and those to all reach all") {
  RelayedFleet fleet;
  wait_for_answer(fleet.robot, message_to("base", "found one"), is_accepted);
  control::Request named = message_to("", "");
  named.mutable_message_send()->set_key("mood");
  named.mutable_message_send()->set_message_class(control::URGENT);
  for (const char* const mood : {"tired", "hungry"}) {
    named.mutable_message_send()->set_content(mood);
    REQUIRE(is_accepted(ask(fleet.robot, named)));
  }
  const control::Messages came = received(fleet.base, {"found one", "hungry"});
  const auto found = std::find_if(came.messages().begin(), came.messages().end(),
                                  [](const auto& message) { return !message.to_all(); });
  REQUIRE(found != came.messages().end());
  CHECK(found->content() == "found one");
  CHECK(found->from() == "robot-1");
  CHECK(found->message_class() == control::NORMAL);
  CHECK(found->time_us() > 0);
  const control::Messages at_relay = received(fleet.relay, {"hungry"});
  for (const auto& message : at_relay.messages()) CHECK(message.to_all());
  CHECK(at_relay.messages(at_relay.messages_size() - 1).key() == "mood");
  CHECK(at_relay.messages(at_relay.messages_size() - 1).message_class() == control::URGENT);

  // The cursor goes on after what was read.
  control::Request next;
  next.mutable_message_watch()->set_inbox(came.inbox());
  next.mutable_message_watch()->set_after(came.next());
  CHECK(ask(fleet.base, next).messages().messages().empty());
  REQUIRE(is_accepted(ask(fleet.base, message_to("robot-1", "come home"))));
  CHECK(received(fleet.robot, {"come home"}).messages(0).from() == "base");
}

TEST_CASE("messages that cannot be sent are refused with a reason") {
  RelayedFleet fleet;
  const auto error_of = [&](const control::Request& request) {
    return ask(fleet.robot, request).error().text();
  };
  CHECK(error_of(message_to("robot-9", "hello")).find("robot-9") != std::string::npos);
  CHECK(error_of(message_to("", std::string(200'001, 'x'))).find("200000") != std::string::npos);
  control::Request request = message_to("", "hello");
  request.mutable_message_send()->set_key("no blanks");
  CHECK(error_of(request).find("key") != std::string::npos);
  wait_for(fleet.robot, [](const control::FleetStatus& status) {
    return node_named(status, "robot-1") != nullptr;
  });
  wait_for_answer(fleet.robot, message_to("robot-1", "hello"),
                  [](const control::Response& response) {
                    return response.error().text().find("this node itself") != std::string::npos;
                  });
  const RunningDaemon alone;
  CHECK(ask(alone, message_to("", "hello")).error().text().find("mesh is off") !=
        std::string::npos);
}

TEST_CASE("a base retracts, restores and clears a robot's layers everywhere, a robot may not") {
  RelayedFleet fleet;
  take_scans(fleet.robot, 1, 3);
  wait_for(fleet.base, has_all_of("robot-1"));
  wait_for(fleet.relay, has_all_of("robot-1"));
  CHECK(state_at(fleet.relay, 105.05) == "occupied");
  const auto refused = ask(fleet.relay, order_on("robot-1", control::FleetOrderRequest::RETRACT));
  CHECK(refused.error().text().find("only a base") != std::string::npos);
  CHECK(ask(fleet.base, order_on("robot-9", control::FleetOrderRequest::RETRACT)).has_error());

  const auto retracted = ask(fleet.base, order_on("robot-1", control::FleetOrderRequest::RETRACT));
  REQUIRE(retracted.fleet_ordered().layers_size() == 1);
  wait_for(fleet.relay, layers_retracted("robot-1", true));
  CHECK(state_at(fleet.relay, 105.05) == "unknown");
  wait_for_state(fleet.base, 105.05, "unknown");
  // Its own map is its own.
  CHECK(fleet.robot.status().map().voxels_occupied() > 0);

  control::Request restore = order_on("", control::FleetOrderRequest::RESTORE);
  *restore.mutable_fleet_order()->mutable_layer() = retracted.fleet_ordered().layers(0);
  REQUIRE(ask(fleet.base, restore).has_fleet_ordered());
  wait_for(fleet.relay, layers_retracted("robot-1", false));
  CHECK(state_at(fleet.relay, 105.05) == "occupied");

  REQUIRE(
      ask(fleet.base, order_on("robot-1", control::FleetOrderRequest::CLEAR)).has_fleet_ordered());
  wait_for(fleet.relay, layers_retracted("robot-1", true));
  fleet.base.request_stop();
  fleet.base.join();
  // Who comes when the base has gone learns of it all the same.
  RunningDaemon late(fleet.loopback.config("robot-3", 3, {2}));
  wait_for(late, has_all_of("robot-1"));
  wait_for(late, layers_retracted("robot-1", true));
  CHECK(state_at(late, 105.05) == "unknown");
}

TEST_CASE("an alignment moves a robot's layer, path and position everywhere, the robot included") {
  RelayedFleet fleet;
  take_scans(fleet.robot, 1, 3);
  wait_for(fleet.base, has_all_of("robot-1"));
  wait_for(fleet.relay, has_all_of("robot-1"));
  control::Request path;
  path.mutable_trajectory()->set_node("robot-1");
  const auto begins_at = [](double x_m) {
    return [x_m](const control::Response& response) {
      return response.trajectory().points_size() > 0 &&
             std::abs(response.trajectory().points(0).x_m() - x_m) < 0.02;
    };
  };
  wait_for_answer(fleet.base, path, begins_at(100.0));
  control::Request align = order_on("robot-1", control::FleetOrderRequest::ALIGN);
  align.mutable_fleet_order()->set_x_m(2.0);
  CHECK(ask(fleet.robot, align).error().text().find("only a base") != std::string::npos);
  const auto aligned = ask(fleet.base, align).fleet_ordered();
  REQUIRE(aligned.layers_size() == 1);
  wait_for_state(fleet.relay, 107.05, "occupied");
  CHECK(state_at(fleet.relay, 105.05) != "occupied");
  wait_for_state(fleet.base, 107.05, "occupied");
  wait_for_answer(fleet.relay, path, begins_at(102.0));
  take_scans(fleet.robot, 4, 1);
  const auto stands_at = [](double x_m) {
    return [x_m](const control::FleetStatus& status) {
      const control::FleetNode* const node = node_named(status, "robot-1");
      return node != nullptr && node->position_fleet_m_size() == 3 &&
             std::abs(node->position_fleet_m(0) - x_m) < 0.01;
    };
  };
  wait_for(fleet.robot, stands_at(102.0));
  // In place of the one before; a layer may be named itself, but not to be cleared.
  align.mutable_fleet_order()->set_x_m(0.0);
  align.mutable_fleet_order()->clear_node();
  *align.mutable_fleet_order()->mutable_layer() = aligned.layers(0);
  align.mutable_fleet_order()->set_what(control::FleetOrderRequest::CLEAR);
  CHECK(ask(fleet.base, align).error().text().find("needs a node") != std::string::npos);
  align.mutable_fleet_order()->set_what(control::FleetOrderRequest::ALIGN);
  REQUIRE(ask(fleet.base, align).has_fleet_ordered());
  wait_for_state(fleet.relay, 105.05, "occupied");
  CHECK(state_at(fleet.relay, 107.05) != "occupied");
  wait_for(fleet.robot, stands_at(100.0));

  control::Request estimate;
  estimate.mutable_align_estimate()->set_node("robot-1");
  CHECK(ask(fleet.base, estimate).error().text().find("--against") != std::string::npos);
}

TEST_CASE("orders, alignments and messages that nobody has fetched are there after a restart") {
  Loopback loopback;
  Config robot_config = loopback.config("robot-1", 1, {0});
  robot_config.node.fleet_T_map.x_m = 100.0;
  robot_config.store.file = loopback.file("robot.db");
  Config base_config = loopback.config("base", 0, {});
  base_config.store.file = loopback.file("base.db");
  {
    RunningDaemon robot(robot_config);
    RunningDaemon base(base_config);
    take_scans(robot, 1, 3);
    wait_for(base, has_all_of("robot-1"));
    control::Request align = order_on("robot-1", control::FleetOrderRequest::ALIGN);
    align.mutable_fleet_order()->set_x_m(2.0);
    REQUIRE(ask(base, align).has_fleet_ordered());
    REQUIRE(
        ask(base, order_on("robot-1", control::FleetOrderRequest::RETRACT)).has_fleet_ordered());
    REQUIRE(is_accepted(ask(base, message_to("robot-1", "come home"))));
    (void)received(robot, {"come home"});
  }
  {
    // Alone: what it knows, its own store has.
    RunningDaemon base(base_config);
    wait_for(base, layers_retracted("robot-1", true));
    REQUIRE(
        ask(base, order_on("robot-1", control::FleetOrderRequest::RESTORE)).has_fleet_ordered());
    wait_for_state(base, 107.05, "occupied");
  }
  RunningDaemon robot(robot_config);
  CHECK(received(robot, {"come home"}).messages_size() == 1);
  wait_for(robot, [](const control::FleetStatus& status) {
    const control::FleetNode* const node = node_named(status, "robot-1");
    return node != nullptr && node->layers_size() == 1 && node->layers(0).latest() > 0;
  });
  control::Request path;
  path.mutable_trajectory()->set_node("robot-1");
  wait_for_answer(robot, path, [](const control::Response& response) {
    return response.trajectory().points_size() > 0 &&
           std::abs(response.trajectory().points(0).x_m() - 102.0) < 0.02;
  });
}

}  // namespace warren
