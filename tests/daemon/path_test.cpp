// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <doctest/doctest.h>

#include "daemon/fleet/fleet_path.hpp"
#include "daemon/fleet/own_path.hpp"

namespace warren {
namespace {

using std::chrono::seconds;

const LayerId kLayer{7, 2, 0x1122334455667788};
constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

MeshTime at(int s) { return MeshTime(seconds(s)); }

PathPoint point_at(int s, double x_m) {
  return {kStart_us + std::int64_t{s} * 1'000'000, {x_m, -0.5, 0.25}};
}

// Drives so far in so many seconds, a tick each; all that was told.
std::vector<PathChunk> drive(OwnPath& path, int ticks, double step_m) {
  std::vector<PathChunk> told;
  for (int s = 0; s < ticks; ++s) {
    const auto part = path.note(at(s), point_at(s, step_m * s));
    if (part) told.push_back(*part);
  }
  return told;
}

}  // namespace

TEST_CASE("a part of a path is read as it was written, to the centimetre and the millisecond") {
  PathChunk chunk{kLayer, 3, {}};
  for (int i = 0; i < 64; ++i) {
    chunk.points.push_back(point_at(i, (i % 2 == 0 ? 1.0 : -1.0) * 31.37 * i));
  }
  const replication::Item item = item_of(chunk);
  CHECK(item.bytes.size() < 64 * 9);
  CHECK(item.name.size() <= replication::Item::kNameMax);
  const auto read = read_path_chunk(item);
  REQUIRE(read.has_value());
  CHECK(read->layer == kLayer);
  CHECK(read->number == 3);
  REQUIRE(read->points.size() == 64);
  for (std::size_t i = 0; i < 64; ++i) {
    CHECK(read->points[i].time_us == chunk.points[i].time_us);
    CHECK((read->points[i].position_layer - chunk.points[i].position_layer).norm() < 0.01);
  }
  for (std::size_t length = 0; length < item.bytes.size(); ++length) {
    replication::Item cut = item;
    cut.bytes.resize(length);
    CHECK_FALSE(read_path_chunk(cut).has_value());
  }
  replication::Item renamed = item;
  renamed.name.back() = 0x7E;
  CHECK_FALSE(read_path_chunk(renamed).has_value());
  const PathChunk small{{1, 2, 3}, 0, {{5'000, {0.01, -0.01, 0.0}}}};
  CHECK(item_of(small).bytes == std::vector<std::uint8_t>{0x34, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0,
                                                          0,    0, 0, 0, 0, 0, 1, 5, 2, 1, 0});
}

TEST_CASE(
    "a path has a point per metre, and is told every ten seconds and whenever a part is full") {
  OwnPath path;
  path.begin(kLayer, 0);
  const auto told = drive(path, 305, 0.5);
  // 153 points: two full parts of 64, and the third as it grew.
  REQUIRE_FALSE(told.empty());
  std::size_t full = 0;
  for (const PathChunk& part : told) full += part.points.size() == PathChunk::kPointsMax ? 1 : 0;
  CHECK(full == 2);
  CHECK(told.back().number == 2);
  CHECK(told.back().points.size() == 153 - 128);
  CHECK(told.size() <= 33);
  for (std::size_t i = 1; i < told.back().points.size(); ++i) {
    const Eigen::Vector3d moved =
        told.back().points[i].position_layer - told.back().points[i - 1].position_layer;
    CHECK(moved.norm() == doctest::Approx(1.0));
  }
}

TEST_CASE("who stands still says nothing, who creeps leaves a point every ten seconds") {
  OwnPath still;
  still.begin(kLayer, 0);
  CHECK(drive(still, 100, 0.0).size() == 1);
  OwnPath creeping;
  creeping.begin(kLayer, 0);
  CHECK(drive(creeping, 101, 0.02).back().points.size() == 11);
}

TEST_CASE("the last word has all points; another layer begins its own parts") {
  OwnPath path;
  path.begin(kLayer, 0);
  REQUIRE(path.note(at(0), point_at(0, 0.0)).has_value());
  CHECK_FALSE(path.note(at(1), point_at(1, 2.0)).has_value());
  const auto last = path.note(at(2), point_at(2, 4.0), true);
  REQUIRE(last.has_value());
  CHECK(last->points.size() == 3);
  path.begin({7, 3, 9}, 5);
  const auto next = path.note(at(30), point_at(30, 0.0));
  REQUIRE(next.has_value());
  CHECK(next->number == 5);
  CHECK(next->layer.number == 3);
  CHECK(next->points.size() == 1);
}

TEST_CASE("a position that makes no sense leaves no point") {
  OwnPath path;
  path.begin(kLayer, 0);
  PathPoint nowhere = point_at(0, 0.0);
  nowhere.position_layer.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(path.note(at(0), nowhere).has_value());
  CHECK_FALSE(path.note(at(1), point_at(1, 1e8)).has_value());
}

TEST_CASE("a path lies where the logs say its layers do, and waits where they do not say it") {
  replication::ReplicationConfig config;
  config.self = {1};
  replication::Replication replication(config);
  OperatorOrders orders;
  const replication::LogId log{7, 1};
  const auto add = [&](replication::ItemNumber number, replication::Item item) {
    replication.log_book().add({}, {log, number, std::move(item)});
  };
  add(0, item_of(PathChunk{kLayer, 1, {point_at(2, 2.0), point_at(3, 3.0)}}));
  add(1, item_of(PathChunk{kLayer, 0, {point_at(0, 0.0), point_at(1, 1.0)}}));
  FleetPath path = path_of(replication, orders, {7}, 0);
  CHECK(path.points.empty());
  CHECK(path.unplaced == 4);
  replication::LayerPoseItem pose{kLayer, false, {}};
  pose.pose = {1, 7, {{100.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()}};
  add(2, replication::item_of(pose));
  path = path_of(replication, orders, {7}, 0);
  REQUIRE(path.points.size() == 4);
  CHECK(path.unplaced == 0);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(path.points[i].position_fleet.x() == doctest::Approx(100.0 + static_cast<double>(i)));
  }
  CHECK(path_of(replication, orders, {7}, kStart_us + 1'000'000).points.size() == 2);
  CHECK(path_of(replication, orders, {8}, 0).points.empty());
  // The operator's word moves it.
  Order align;
  align.verb = Order::Verb::kAlign;
  align.revision = 1;
  align.writer = 3;
  align.node = 7;
  align.layer = kLayer;
  align.correction.translation = {0.0, 10.0, 0.0};
  REQUIRE(orders.note(3, item_of(align)));
  orders.settle({3});
  CHECK(path_of(replication, orders, {7}, 0).points[0].position_fleet.y() == doctest::Approx(9.5));
}

}  // namespace warren
