// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <doctest/doctest.h>

#include "proto/framing.hpp"
#include "tests/daemon/frames.hpp"
#include "tests/daemon/running_daemon.hpp"
#include "tests/daemon/test_client.hpp"

namespace warren {
namespace {

constexpr double kFloor_m = -0.55;

// A floor of 4 m by 4 m around (3, 0) that rises along x, in the frame of a sensor at the origin.
std::vector<Point3f> floor_points(double slope_rad) {
  std::vector<Point3f> points;
  for (int i = 0; i < 160; ++i) {
    for (int j = 0; j < 160; ++j) {
      const double x = 1.0 + 0.025 * i;
      points.push_back({static_cast<float>(x), static_cast<float>(-2.0 + 0.025 * j),
                        static_cast<float>(kFloor_m + (x - 3.0) * std::tan(slope_rad))});
    }
  }
  return points;
}

struct Gravity {
  double x = 0.0;
  double z = -1.0;
};

void take_floor(const RunningDaemon& daemon, double slope_rad, const Gravity& gravity = {}) {
  const auto points = floor_points(slope_rad);
  auto request = scan_request(1, points.size());
  auto& down = *request.mutable_scan()->mutable_gravity_map();
  down.set_x(gravity.x);
  down.set_z(gravity.z);
  TestClient client = greeted_client(daemon.ingest_socket());
  REQUIRE(client.write(framed(request.SerializeAsString()) + payload_of(points)));
  REQUIRE(client.read_receipt().outcome() == ingest::ScanReceipt::TAKEN);
}

control::Request request_at(double x, double y, double z) {
  control::Request request;
  auto& ground = *request.mutable_ground();
  for (const double number : {x, y, z, 0.0, 0.0, 0.0, 1.0}) ground.add_t_map_base(number);
  ground.set_length_m(0.8);
  ground.set_width_m(0.6);
  return request;
}

control::Response ask(const RunningDaemon& daemon, const control::Request& request) {
  return TestClient(daemon.control_socket()).ask(request);
}

}  // namespace

TEST_CASE(
    "the control socket tells the ground under a footprint, and whether one may stand there") {
  RunningDaemon daemon;
  CHECK(ask(daemon, request_at(0, 0, 0)).error().text().find("no map yet") != std::string::npos);
  take_floor(daemon, 0.0);

  const auto floor = ask(daemon, request_at(3.0, 0.0, kFloor_m)).ground();
  CHECK(floor.validity() == "traversable");
  CHECK(floor.valid());
  CHECK(floor.columns() == 16 * 12);
  CHECK(floor.columns_with_cost() == floor.columns());
  CHECK(floor.mean_cost() < 0.01);
  CHECK(floor.max_cost() < 0.05);
  CHECK(floor.unknown_share() == 0.0);

  const auto beside = ask(daemon, request_at(30.0, 0.0, kFloor_m)).ground();
  CHECK(beside.validity() == "unknown");
  CHECK_FALSE(beside.valid());
  CHECK_FALSE(beside.has_mean_cost());
  CHECK(beside.unknown_share() == 1.0);

  const auto info = daemon.status().map();
  CHECK(info.cost_up_to_0p10() > 1000);
  CHECK(info.cost_up_to_0p10() + info.cost_up_to_0p20() + info.cost_above_0p20() +
            info.cost_no_data() ==
        info.voxels_occupied());
}

TEST_CASE("a slope is too hard, and gravity is the scan's unless the question brings its own") {
  const double slope_rad = 0.7;
  RunningDaemon daemon;
  take_floor(daemon, slope_rad);
  CHECK(ask(daemon, request_at(3.0, 0.0, kFloor_m)).ground().validity() == "too_hard");

  RunningDaemon tilted;  // its frame leans with the ramp: level to the eye, steep to gravity
  take_floor(tilted, 0.0, {std::sin(slope_rad), -std::cos(slope_rad)});
  CHECK(ask(tilted, request_at(3.0, 0.0, kFloor_m)).ground().validity() == "too_hard");
  auto upright = request_at(3.0, 0.0, kFloor_m);
  for (const double number : {0.0, 0.0, -2.0}) upright.mutable_ground()->add_gravity_map(number);
  CHECK(ask(tilted, upright).ground().columns_with_ground() == 16 * 12);
}

TEST_CASE("unknown ground is put up with as far as one says, in the own map and the merge-map") {
  Config config;
  config.layer.tick_s = 0.1;
  RunningDaemon daemon(config);
  take_floor(daemon, 0.0);
  // The last of 72 rows of columns lies beyond the floor's edge at y = 2.
  auto edge = request_at(3.0, 0.25, kFloor_m);
  edge.mutable_ground()->set_width_m(3.6);
  edge.mutable_ground()->set_length_m(0.3);
  for (const auto source : {control::SELF, control::MERGE}) {
    edge.mutable_ground()->set_source(source);
    edge.mutable_ground()->set_unknown_up_to(0.0);
    control::Ground strict;
    // The merge-map has the floor after the next tick.
    for (int asked = 0; asked < 100'000 && strict.columns_with_ground() == 0; ++asked) {
      strict = ask(daemon, edge).ground();
    }
    CHECK(strict.validity() == "unknown");
    CHECK(strict.unknown_share() > 0.01);
    CHECK(strict.unknown_share() < 0.05);
    edge.mutable_ground()->set_unknown_up_to(0.005);
    CHECK(ask(daemon, edge).ground().validity() == "unknown");
    edge.mutable_ground()->set_unknown_up_to(0.05);
    CHECK(ask(daemon, edge).ground().validity() == "traversable");
  }
  const auto error_of = [&](double share) {
    auto request = edge;
    request.mutable_ground()->set_unknown_up_to(share);
    return ask(daemon, request).error().text();
  };
  for (const double wrong : {-0.1, 1.1, std::nan("")}) {
    CHECK(error_of(wrong).find("0 to 1") != std::string::npos);
  }
}

TEST_CASE("questions about ground that make no sense are answered by an error") {
  RunningDaemon daemon;
  take_floor(daemon, 0.0);
  const auto error_of = [&](auto change) {
    auto request = request_at(3.0, 0.0, kFloor_m);
    change(*request.mutable_ground());
    return ask(daemon, request).error().text();
  };
  using Ground = control::GroundRequest;
  CHECK(error_of([](Ground& g) { g.clear_t_map_base(); }).find("7 numbers") != std::string::npos);
  CHECK(error_of([](Ground& g) { g.set_t_map_base(6, 5.0); }).find("rigid") != std::string::npos);
  CHECK(error_of([](Ground& g) { g.set_t_map_base(0, NAN); }).find("rigid") != std::string::npos);
  CHECK(error_of([](Ground& g) { g.set_length_m(-1.0); }).find("no sense") != std::string::npos);
  CHECK(error_of([](Ground& g) { g.set_width_m(500.0); }).find("no sense") != std::string::npos);
  CHECK(error_of([](Ground& g) { g.set_below_m(NAN); }).find("no sense") != std::string::npos);
  CHECK(error_of([](Ground& g) {
          g.set_above_m(100.0);
          g.set_below_m(100.0);
        }).find("131072 voxels") != std::string::npos);
  CHECK(error_of([](Ground& g) { g.add_gravity_map(1.0); }).find("3 numbers") != std::string::npos);
  CHECK(daemon.status().node() == "robot");
}

TEST_CASE("a picture can show costs, and clouds bear them") {
  RunningDaemon daemon;
  take_floor(daemon, 0.0);
  control::Request request;
  request.mutable_map_save()->set_path(daemon.file("cost.png"));
  request.mutable_map_save()->set_colours(control::COST);
  REQUIRE(ask(daemon, request).has_map_saved());
  const auto cost_bytes = std::filesystem::file_size(daemon.file("cost.png"));
  request.mutable_map_save()->set_path(daemon.file("height.png"));
  request.mutable_map_save()->set_colours(control::HEIGHT);
  REQUIRE(ask(daemon, request).has_map_saved());
  CHECK(std::filesystem::file_size(daemon.file("height.png")) != cost_bytes);
  request.mutable_map_save()->set_colours(static_cast<control::PictureColours>(77));
  CHECK(ask(daemon, request).error().text().find("colours") != std::string::npos);
}

}  // namespace warren
