// SPDX-License-Identifier: Apache-2.0
// Subscriptions on the control socket.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "proto/framing.hpp"
#include "tests/daemon/block_copy.hpp"
#include "tests/daemon/frames.hpp"
#include "tests/daemon/mapped_daemon.hpp"
#include "tests/daemon/test_client.hpp"

namespace warren {

using namespace test;

namespace {

control::Request blocks_request(control::MapSource source) {
  control::Request request;
  request.mutable_blocks()->set_source(source);
  return request;
}

std::vector<BlockKey> keys_of(const control::Blocks& blocks) {
  std::vector<BlockKey> keys;
  for (int i = 0; i + 2 < blocks.keys_size(); i += 3) {
    keys.push_back({blocks.keys(i), blocks.keys(i + 1), blocks.keys(i + 2)});
  }
  return keys;
}

control::Blocks read_blocks(TestClient& client) {
  control::Response response;
  REQUIRE(response.ParseFromString(client.read_frame().value()));
  REQUIRE_MESSAGE(response.has_blocks(), response.error().text());
  return response.blocks();
}

// All that there is; the request then goes on from there.
BlockCopy whole_copy(TestClient& client, control::Request& request) {
  BlockCopy copy;
  for (bool more = true; more;) {
    const control::Response response = client.ask(request);
    REQUIRE_MESSAGE(response.has_blocks(), response.error().text());
    REQUIRE(copy.apply(response.blocks().anew(), keys_of(response.blocks()),
                       response.blocks().codes()));
    request.mutable_blocks()->set_cursor(response.blocks().cursor());
    more = response.blocks().more();
  }
  return copy;
}

// A sensor at the origin sees a wall at x = 5.05.
VoxelKey key_at(const control::Blocks& blocks, double x, double y, double z) {
  const auto axis = [&](int i, double place) {
    return static_cast<std::int32_t>(
        std::floor((place - blocks.origin_map_m(i)) / blocks.resolution_m()));
  };
  return {axis(0, x), axis(1, y), axis(2, z)};
}

}  // namespace

TEST_CASE("a subscriber's copy holds what cells tell, of the own layer and of the merge-map") {
  RunningDaemon daemon(quick_ticks());
  TestClient client(daemon.control_socket());
  for (const auto source : {control::SELF, control::MERGE}) {
    const auto response = client.ask(blocks_request(source));
    CHECK(response.error().text().find("no map yet") != std::string::npos);
  }
  take_scan(daemon, 1);
  wait_until_published(daemon);
  for (const auto source : {control::SELF, control::MERGE}) {
    control::Request request = blocks_request(source);
    request.mutable_blocks()->set_most_bytes(4096);
    const control::Blocks first = client.ask(request).blocks();
    CHECK(first.anew());
    CHECK(first.codes().size() <= 4096);
    CHECK(first.t_fleet_map_size() == 7);
    CHECK(first.position_map_m_size() == 3);
    const BlockCopy copy = whole_copy(client, request);
    CHECK(copy.known().size() > 1000);
    for (const double x : {0.55, 2.05, 4.95, 5.05, 5.15}) {
      control::Request cells;
      for (const double coordinate : {x, 0.0, 0.0})
        cells.mutable_cells()->add_low_map_m(coordinate);
      cells.mutable_cells()->set_source(source);
      const std::string state = client.ask(cells).cells().cells(0).state();
      const std::uint8_t code = copy.code(key_at(first, x, 0.0, 0.0));
      CHECK(state == std::vector<std::string>{"unknown", "free", "occupied"}.at(code & 3));
    }
  }
}

TEST_CASE("an answer waits for a change, and then holds that change alone") {
  MappedDaemon daemon;
  TestClient client(daemon.control_socket());
  control::Request request = blocks_request(control::MERGE);
  whole_copy(client, request);
  request.mutable_blocks()->set_wait_s(50.0);
  request.mutable_blocks()->set_rate_hz(10.0);
  REQUIRE(client.write(framed(request.SerializeAsString())));
  take_scan(daemon, 2);
  const control::Blocks changed = read_blocks(client);
  CHECK_FALSE(changed.anew());
  CHECK(changed.keys_size() > 0);
}

TEST_CASE("without a change an answer comes when the wait is over, and has nothing") {
  MappedDaemon daemon;
  TestClient client(daemon.control_socket());
  for (const double wait_s : {0.0, 0.25}) {
    control::Request request = blocks_request(control::MERGE);
    whole_copy(client, request);
    request.mutable_blocks()->set_wait_s(wait_s);
    const control::Blocks nothing = client.ask(request).blocks();
    CHECK_FALSE(nothing.anew());
    CHECK_FALSE(nothing.more());
    CHECK(nothing.keys_size() == 0);
    CHECK(nothing.codes().empty());
  }
}

TEST_CASE("clients that go away while they wait leave their places to others") {
  MappedDaemon daemon;
  control::Request request = blocks_request(control::MERGE);
  {
    TestClient client(daemon.control_socket());
    whole_copy(client, request);
  }
  request.mutable_blocks()->set_wait_s(60.0);
  for (int generation = 0; generation < 4; ++generation) {
    std::vector<std::unique_ptr<TestClient>> clients;
    while (clients.size() < ControlServer::kMaxClients) {
      auto client = std::make_unique<TestClient>(daemon.control_socket());
      // Refused while the daemon has not noticed yet that those before are gone.
      control::Request info;
      info.mutable_config_print();
      if (!client->write(framed(info.SerializeAsString()))) continue;
      control::Response response;
      const auto frame = client->read_frame();
      if (!frame || !response.ParseFromString(*frame) || !response.has_config()) continue;
      REQUIRE(client->write(framed(request.SerializeAsString())));
      clients.push_back(std::move(client));
    }
  }
}

TEST_CASE("a daemon that stops answers those who wait") {
  MappedDaemon daemon;
  TestClient client(daemon.control_socket());
  control::Request request = blocks_request(control::MERGE);
  whole_copy(client, request);
  request.mutable_blocks()->set_wait_s(60.0);
  request.mutable_blocks()->set_rate_hz(0.1);
  REQUIRE(client.write(framed(request.SerializeAsString())));
  // Answered after it, on the same thread.
  CHECK(daemon.status().node() == "robot");
  daemon.request_stop();
  CHECK(read_blocks(client).keys_size() == 0);
  CHECK(client.is_at_end());
  daemon.join();
}

TEST_CASE("one who asks and does not read holds up nobody, and is told the newest state at last") {
  MappedDaemon daemon;
  constexpr int kAsked = 40;
  TestClient slow(daemon.control_socket());
  const std::string request = framed(blocks_request(control::MERGE).SerializeAsString());
  for (int i = 0; i < kAsked; ++i) REQUIRE(slow.write(request));
  for (std::uint64_t sequence = 2; sequence < 6; ++sequence) {
    take_scan(daemon, sequence);
    CHECK(daemon.status().node() == "robot");
  }
  for (int i = 0; i < kAsked; ++i) CHECK(read_blocks(slow).anew());
}

TEST_CASE("questions about blocks that make no sense are refused") {
  MappedDaemon daemon;
  TestClient client(daemon.control_socket());
  const auto error_of = [&](auto change) {
    control::Request request = blocks_request(control::MERGE);
    change(*request.mutable_blocks());
    return client.ask(request).error().text();
  };
  using Blocks = control::BlocksRequest;
  const auto add = [](google::protobuf::RepeatedField<double>& field, double value) {
    for (int i = 0; i < 3; ++i) field.Add(value);
  };
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(error_of([&](Blocks& b) { add(*b.mutable_low_map_m(), 0.0); }).find("3 numbers") !=
        std::string::npos);
  CHECK(error_of([&](Blocks& b) {
          add(*b.mutable_low_map_m(), 1.0);
          add(*b.mutable_high_map_m(), 0.0);
        }).find("below high_map_m") != std::string::npos);
  CHECK(error_of([&](Blocks& b) {
          add(*b.mutable_low_map_m(), 1.0);
          add(*b.mutable_high_map_m(), infinite);
        }).find("finite") != std::string::npos);
  for (const double wrong : {-1.0, 61.0, std::nan("")}) {
    CHECK(error_of([&](Blocks& b) { b.set_wait_s(wrong); }).find("0 to 60") != std::string::npos);
  }
  for (const double wrong : {0.0, 0.05, 11.0, std::nan("")}) {
    CHECK(error_of([&](Blocks& b) { b.set_rate_hz(wrong); }).find("0.1 to 10") !=
          std::string::npos);
  }
  for (const std::uint32_t wrong : {1U, 4095U, 1048577U}) {
    CHECK(error_of([&](Blocks& b) { b.set_most_bytes(wrong); }).find("4096") != std::string::npos);
  }
  CHECK(error_of([&](Blocks& b) { b.set_cursor("?"); }).find("cursor") != std::string::npos);
  control::Request request = blocks_request(control::MERGE);
  whole_copy(client, request);
  request.mutable_blocks()->set_source(control::SELF);
  CHECK(client.ask(request).error().text().find("another source or box") != std::string::npos);
}

TEST_CASE("a cursor of an earlier run of the daemon begins anew") {
  control::Request request = blocks_request(control::SELF);
  for (int run = 0; run < 2; ++run) {
    MappedDaemon daemon;
    TestClient client(daemon.control_socket());
    const control::Blocks blocks = client.ask(request).blocks();
    CHECK(blocks.anew());
    request.mutable_blocks()->set_cursor(blocks.cursor());
    CHECK_FALSE(client.ask(request).blocks().anew());
  }
}

}  // namespace warren
