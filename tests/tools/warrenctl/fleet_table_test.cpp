// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/fleet_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <sstream>

#include <doctest/doctest.h>

#include "tools/warrenctl/tables.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr std::int64_t kAt123107_us = 45'067'000'000;

// A robot that is heard, of which all is here.
struct Shown {
  Shown() {
    setenv("TZ", "UTC0", 1);
    tzset();
    status.set_mesh_on(true);
    auto& self = *status.add_nodes();
    self.set_name("base");
    self.set_role("base");
    self.set_is_self(true);
    node = status.add_nodes();
    node->set_name("robot-1");
    node->set_role("robot");
    node->set_status_us(kAt123107_us);
    node->set_status_came_s(2.0);
    auto& link = *node->mutable_link();
    link.set_up(true);
    link.set_interface("wlan0");
    link.set_rtt_ms(120.0);
    link.set_rate_kbit_s(2400.0);
    layer = node->add_layers();
    layer->set_held_everywhere(1234);
    layer->set_held_wanted(1234);
    layer->set_latest(1234);
    layer->set_up_to_us(kAt123107_us);
    layer->set_digest_equal(true);
    layer->set_hops(1);
  }
  // Of the robot.
  std::string row() const {
    std::istringstream table(table_of(status));
    std::string line;
    while (std::getline(table, line)) {
      if (line.rfind("robot-1", 0) == 0) return line;
    }
    return "there is none";
  }
  bool has(const std::string& text) const { return row().find(text) != std::string::npos; }

  control::FleetStatus status;
  control::FleetNode* node = nullptr;
  control::FleetLayer* layer = nullptr;
};

}  // namespace

TEST_CASE("the map's bytes from and to a neighbour stand in its row, new ones and backlog apart") {
  Shown shown;
  auto& received = *shown.node->mutable_link()->mutable_received();
  received.set_fresh_bytes(1'540);
  received.set_backlog_bytes(340'400);
  shown.node->mutable_link()->mutable_sent()->set_backlog_bytes(12'000);
  CHECK(table_of(shown.status).find("kB in/out") != std::string::npos);
  CHECK(shown.has(" 1.5+340/0+12 "));
}

TEST_CASE("who has all is told up to when, and the rows of such a fleet fit on a screen") {
  const Shown shown;
  CHECK(shown.has("has all of robot-1 up to 12:31:07, digest equal"));
  CHECK(shown.row().size() <= 140);
}

TEST_CASE("what lags is told up to when it is here all the same") {
  Shown shown;
  shown.layer->set_latest(1240);
  shown.layer->set_lag_revisions(6);
  shown.layer->set_lag_s(5.94);
  shown.layer->set_lag_voxels(340);
  shown.layer->set_provider("robot-2");
  CHECK(shown.has("1234/1240"));
  CHECK(shown.has("6 rev, 5.9 s"));
  CHECK(shown.has("comes from robot-2, up to 12:31:07, 340 voxels fewer"));
  shown.layer->clear_provider();
  shown.layer->set_hops(16);
  CHECK(shown.has("nobody here has more, up to 12:31:07"));
}

TEST_CASE("a copy of what is near has all within that radius") {
  Shown shown;
  shown.layer->set_held_everywhere(3);
  shown.layer->set_within_m(50.0);
  CHECK(shown.has("1234/1234"));
  CHECK(shown.has("has all of robot-1 within 50 m up to 12:31:07"));
}

TEST_CASE("a node that is not heard itself shows the time of its last word, if one has come") {
  Shown shown;
  shown.node->clear_link();
  CHECK(shown.has(" by others "));
  CHECK(shown.has(" 12:31:07 "));
  shown.node->clear_status_came_s();
  CHECK(shown.has(" not since start "));
  CHECK(shown.has(" 12:31:07 "));
  CHECK_FALSE(shown.has("by others"));
}

TEST_CASE("a JSON object can have a line for itself") {
  const std::string line = json_line_of(Shown().status);
  CHECK(std::count(line.begin(), line.end(), '\n') == 1);
  CHECK(line.back() == '\n');
  CHECK(line.find("\"name\":\"robot-1\"") != std::string::npos);
}

}  // namespace warren
