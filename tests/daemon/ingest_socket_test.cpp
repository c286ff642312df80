// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "proto/framing.hpp"
#include "tests/daemon/frames.hpp"
#include "tests/daemon/running_daemon.hpp"
#include "tests/daemon/test_client.hpp"

namespace warren {
namespace {

constexpr auto kTaken = ingest::ScanReceipt::TAKEN;

std::string with_sensor(ingest::IngestRequest request, const std::string& sensor) {
  request.mutable_scan()->set_sensor(sensor);
  return framed(request.SerializeAsString()) + payload_of(wall_points(request.scan().points()));
}

// Garbage of one kind; the daemon says why and closes. The counter's name comes back.
void check_refused(RunningDaemon& daemon, const std::string& bytes, const std::string& reason) {
  CAPTURE(reason);
  const std::uint64_t before = count_named(daemon.status().refused_frames(), reason);
  TestClient client(daemon.ingest_socket());
  client.write(bytes);
  std::optional<ingest::IngestReply> last;
  while (auto reply = client.read_reply()) last = std::move(reply);
  REQUIRE(last.has_value());
  CHECK(last->has_failure());
  CHECK_FALSE(last->failure().reason().empty());
  CHECK(count_named(daemon.status().refused_frames(), reason) == before + 1);
}

void check_works(RunningDaemon& daemon, std::uint64_t sequence) {
  TestClient client = greeted_client(daemon.ingest_socket());
  REQUIRE(client.write(scan_frame(sequence)));
  CHECK(client.read_receipt().outcome() == kTaken);
}

}  // namespace

TEST_CASE("a welcome tells what may be sent") {
  RunningDaemon daemon;
  TestClient client(daemon.ingest_socket());
  client.write(hello_frame());
  const auto reply = client.read_reply();
  REQUIRE(reply.has_value());
  CHECK(reply->welcome().protocol_version() == 1);
  CHECK(reply->welcome().queue_scans() == daemon.config().ingest.queue_scans);
  CHECK(reply->welcome().max_payload_bytes() == std::uint64_t{262144} * 44);
  REQUIRE(reply->welcome().sensors_size() == 1);
  CHECK(reply->welcome().sensors(0) == "lidar");
}

TEST_CASE("a scan is taken and its voxels are in the map") {
  RunningDaemon daemon;
  TestClient client = greeted_client(daemon.ingest_socket());
  REQUIRE(client.write(scan_frame(7, 1024)));
  const auto receipt = client.read_receipt();
  CHECK(receipt.outcome() == kTaken);
  CHECK(receipt.sequence() == 7);
  CHECK(receipt.points_used() == 1024);
  const auto map = daemon.status().map();
  CHECK(map.scans() == 1);
  CHECK(map.voxels_occupied() > 700);
  CHECK(map.voxels_free() > 10000);
}

TEST_CASE("a client that is killed within a message harms nobody") {
  RunningDaemon daemon;
  const std::string frame = scan_frame(1, 100000);
  for (const std::size_t cut : {std::size_t{2}, std::size_t{40}, frame.size() - 1}) {
    TestClient client = greeted_client(daemon.ingest_socket());
    client.write(frame.substr(0, cut));
    client.close();
  }
  check_works(daemon, 1);
  while (count_named(daemon.status().refused_frames(), "truncated") < 3) std::this_thread::yield();
  CHECK(daemon.status().map().scans() == 1);
}

TEST_CASE("a client that stalls is closed in time and others go on meanwhile") {
  Config config;
  config.ingest.message_timeout_s = 0.2;
  RunningDaemon daemon(config);
  TestClient stalled = greeted_client(daemon.ingest_socket());
  REQUIRE(stalled.write(scan_frame(1, 100000).substr(0, 5000)));
  TestClient silent(daemon.ingest_socket());
  for (std::uint64_t i = 1; i <= 20; ++i) check_works(daemon, i);
  for (TestClient* const client : {&stalled, &silent}) {
    const auto reply = client->read_reply();
    REQUIRE(reply.has_value());
    CHECK(reply->failure().reason().find("message_timeout_s") != std::string::npos);
    CHECK(client->is_at_end());
  }
  CHECK(count_named(daemon.status().refused_frames(), "stalled") == 2);
}

TEST_CASE("a client that is idle between messages stays") {
  Config config;
  config.ingest.message_timeout_s = 0.05;
  RunningDaemon daemon(config);
  TestClient idle = greeted_client(daemon.ingest_socket());
  TestClient silent(daemon.ingest_socket());
  CHECK(silent.read_reply()->has_failure());  // so more than the timeout has passed
  REQUIRE(idle.write(scan_frame(1)));
  CHECK(idle.read_receipt().outcome() == kTaken);
}

TEST_CASE("garbage of every kind is refused with a reason, counted, and harms nobody") {
  RunningDaemon daemon;
  auto many = scan_request(1, 0);
  many.mutable_scan()->set_points(300000);
  auto extra = scan_request(1, 1);
  extra.mutable_scan()->add_extras()->set_name("ring");
  check_refused(daemon, "GET / HTTP/1.1\r\n\r\n", "header_length");
  check_refused(daemon, std::string(4, '\0'), "header_length");
  check_refused(daemon, framed("\xFF\xFF\xFF\xFF"), "not_protobuf");
  check_refused(daemon, framed(std::string("\x7A\x00", 2)), "no_body");
  check_refused(daemon, scan_frame(1), "no_hello");
  check_refused(daemon, hello_frame() + hello_frame(), "second_hello");
  check_refused(daemon, hello_frame() + framed(many.SerializeAsString()), "too_many_points");
  check_refused(daemon, hello_frame() + framed(extra.SerializeAsString()), "bad_extras");
  check_refused(daemon, hello_frame() + with_sensor(scan_request(1, 1), "sonar"), "unknown_sensor");
  check_works(daemon, 1);
}

TEST_CASE("one client too many is told so") {
  Config config;
  config.ingest.max_clients = 1;
  RunningDaemon daemon(config);
  TestClient first = greeted_client(daemon.ingest_socket());
  check_refused(daemon, "", "too_many_clients");
  REQUIRE(first.write(scan_frame(1)));
  CHECK(first.read_receipt().outcome() == kTaken);
}

TEST_CASE("a full queue drops the oldest scans, keeps the newest, and the counts add up") {
  Config config;
  config.ingest.queue_scans = 3;
  RunningDaemon daemon(config);
  daemon.gate().shut();
  TestClient client = greeted_client(daemon.ingest_socket());
  REQUIRE(client.write(scan_frame(1)));
  daemon.gate().wait_until_somebody_waits();  // scan 1 has left the queue
  for (std::uint64_t i = 2; i <= 10; ++i) REQUIRE(client.write(scan_frame(i)));
  for (std::uint64_t i = 2; i <= 7; ++i) {
    const auto receipt = client.read_receipt();
    CHECK(receipt.sequence() == i);
    CHECK(receipt.outcome() == ingest::ScanReceipt::DROPPED_OVERLOAD);
  }
  daemon.gate().open();
  for (const std::uint64_t i : {1U, 8U, 9U, 10U}) {
    const auto receipt = client.read_receipt();
    CHECK(receipt.sequence() == i);
    CHECK(receipt.outcome() == kTaken);
  }
  const auto sensor = daemon.status().sensors(0);
  CHECK(sensor.received() == 10);
  CHECK(sensor.taken() == 4);
  CHECK(sensor.dropped_overload() == 6);
}

TEST_CASE("two clients with a sensor each are mapped at once") {
  Config config;
  config.sensors.push_back(config.sensors.front());
  config.sensors.back().name = "rear";
  RunningDaemon daemon(config);
  TestClient front = greeted_client(daemon.ingest_socket());
  TestClient rear = greeted_client(daemon.ingest_socket());
  for (std::uint64_t i = 1; i <= 5; ++i) {
    REQUIRE(front.write(scan_frame(i)));
    REQUIRE(rear.write(with_sensor(scan_request(i, 64), "rear")));
    CHECK(front.read_receipt().outcome() == kTaken);
    CHECK(rear.read_receipt().outcome() == kTaken);
  }
  const auto status = daemon.status();
  REQUIRE(status.sensors_size() == 2);
  CHECK(status.sensors(0).taken() == 5);
  CHECK(status.sensors(1).taken() == 5);
  CHECK(status.map().scans() == 10);
  CHECK(status.clients() == 2);
}

TEST_CASE("a scan that is not newer than the last one is dropped") {
  RunningDaemon daemon;
  TestClient client = greeted_client(daemon.ingest_socket());
  for (const std::uint64_t stamp : {5U, 5U, 4U}) REQUIRE(client.write(scan_frame(stamp)));
  std::size_t dropped = 0;
  for (int i = 0; i < 3; ++i) {
    if (client.read_receipt().outcome() == ingest::ScanReceipt::DROPPED_OUT_OF_ORDER) ++dropped;
  }
  CHECK(dropped == 2);
  CHECK(daemon.status().sensors(0).dropped_out_of_order() == 2);
}

TEST_CASE("a scan that cannot be used is rejected with its reason and the client goes on") {
  RunningDaemon daemon;
  TestClient client = greeted_client(daemon.ingest_socket());
  auto request = scan_request(1, 0);
  request.mutable_scan()->clear_t_map_base();
  REQUIRE(client.write(framed(request.SerializeAsString())));
  auto receipt = client.read_receipt();
  CHECK(receipt.outcome() == ingest::ScanReceipt::REJECTED);
  CHECK(receipt.reason() == "bad_pose");
  REQUIRE(client.write(scan_frame(2)));
  CHECK(client.read_receipt().outcome() == kTaken);
  CHECK(daemon.status().map().layers() == 1);
  CHECK(count_named(daemon.status().rejected_points(), "bad_pose") == 1);
}

TEST_CASE("a new epoch opens a layer; poses move the current one, in the order of messages") {
  RunningDaemon daemon;
  daemon.gate().shut();
  TestClient client = greeted_client(daemon.ingest_socket());
  auto second = scan_request(2, 0);
  second.mutable_scan()->set_frame_epoch(2);
  REQUIRE(client.write(scan_frame(1) + pose_update_frame(1, 3.0) +
                       framed(second.SerializeAsString()) + pose_update_frame(1, 4.0) +
                       pose_update_frame(2, 5.0) + scan_frame(9)));
  daemon.gate().open();
  CHECK(client.read_receipt().outcome() == kTaken);
  CHECK(client.read_reply()->pose_updated().applied());
  CHECK(client.read_receipt().outcome() == kTaken);
  CHECK_FALSE(client.read_reply()->pose_updated().applied());
  CHECK(client.read_reply()->pose_updated().applied());
  const auto late = client.read_receipt();
  CHECK(late.outcome() == ingest::ScanReceipt::REJECTED);
  CHECK(late.reason().find("frame_epoch") == 0);
  const auto map = daemon.status().map();
  CHECK(map.layers() == 2);
  CHECK(map.frame_epoch() == 2);
  REQUIRE(map.t_fleet_map_size() == 7);
  CHECK(map.t_fleet_map(0) == 5.0);
}

TEST_CASE("scans of a client that closes without reading its receipts are all mapped") {
  RunningDaemon daemon;
  daemon.gate().shut();
  {
    TestClient hasty = greeted_client(daemon.ingest_socket());
    for (std::uint64_t i = 1; i <= 5; ++i) REQUIRE(hasty.write(scan_frame(i)));
    daemon.gate().wait_until_somebody_waits();
  }
  daemon.gate().open();
  while (daemon.status().map().scans() < 5) std::this_thread::yield();
  while (daemon.status().clients() > 0) std::this_thread::yield();
  CHECK(daemon.status().sensors(0).taken() == 5);
}

TEST_CASE("a client that ends its side still gets every receipt") {
  RunningDaemon daemon;
  daemon.gate().shut();
  TestClient client = greeted_client(daemon.ingest_socket());
  for (std::uint64_t i = 1; i <= 5; ++i) REQUIRE(client.write(scan_frame(i)));
  client.end_writing();
  daemon.gate().open();
  for (std::uint64_t i = 1; i <= 5; ++i) CHECK(client.read_receipt().sequence() == i);
  CHECK(client.is_at_end());
  while (daemon.status().clients() > 0) std::this_thread::yield();
}

TEST_CASE("a client that never reads its receipts goes on being mapped") {
  RunningDaemon daemon;
  TestClient deaf = greeted_client(daemon.ingest_socket());
  TestClient other = greeted_client(daemon.ingest_socket());
  for (std::uint64_t i = 1; daemon.status().replies_dropped() == 0; ++i) {
    std::string many;
    for (std::uint64_t k = 0; k < 1000; ++k) many += scan_frame(i * 1000 + k, 0);
    REQUIRE(deaf.write(many));
    REQUIRE(i < 1000);
  }
  REQUIRE(other.write(scan_frame(10000000)));
  CHECK(other.read_receipt().outcome() == kTaken);
}

}  // namespace warren
