// SPDX-License-Identifier: Apache-2.0
#include "daemon/ingest/decoder.hpp"

#include <algorithm>
#include <cstring>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "proto/framing.hpp"
#include "tests/daemon/frames.hpp"

namespace warren {
namespace {

const IngestLimits kLimits{100000, {"lidar", "rear"}};

struct Decoded {
  std::vector<IngestMessage> messages;
  std::optional<Refused> refused;
  std::size_t bytes_used = 0;
};

// Feeds the stream in pieces whose sizes come from `pieces`, over and over.
Decoded decode(const std::string& stream, const std::vector<std::size_t>& pieces) {
  IngestDecoder decoder;
  Decoded decoded;
  for (std::size_t turn = 0; decoded.bytes_used < stream.size(); ++turn) {
    const auto buffer = decoder.buffer();
    if (buffer.empty() || buffer.size() > IngestDecoder::kChunkBytes) FAIL("bad buffer");
    const std::size_t piece = pieces.empty() ? stream.size() : pieces[turn % pieces.size()];
    const std::size_t count = std::min(
        {buffer.size(), std::max<std::size_t>(piece, 1), stream.size() - decoded.bytes_used});
    std::memcpy(buffer.data(), stream.data() + decoded.bytes_used, count);
    decoded.bytes_used += count;
    auto message = decoder.commit(count, kLimits);
    if (!message) {
      decoded.refused = message.error();
      return decoded;
    }
    if (*message) decoded.messages.push_back(std::move(**message));
  }
  return decoded;
}

std::string stream_of_everything() {
  auto request = scan_request(2, 25000);
  auto& scan = *request.mutable_scan();
  scan.set_no_returns(3);
  const auto add_extra = [&](const char* name, ingest::Extra::Type type) {
    scan.add_extras()->set_name(name);
    scan.mutable_extras(scan.extras_size() - 1)->set_type(type);
  };
  add_extra("stair", ingest::Extra::UINT8);
  add_extra("ring", ingest::Extra::UINT16);
  add_extra("intensity", ingest::Extra::FLOAT32);
  return hello_frame() + scan_frame(1, 7) + framed(request.SerializeAsString()) +
         payload_of(wall_points(25003)) + std::string(std::size_t{25000} * 7, 'x') +
         pose_update_frame(1, 2.0) + scan_frame(3, 0);
}

void check_refused(const ingest::IngestRequest& request, Refusal refusal) {
  const Decoded decoded = decode(hello_frame() + framed(request.SerializeAsString()), {});
  REQUIRE(decoded.refused.has_value());
  CHECK(name_of(decoded.refused->refusal) == std::string(name_of(refusal)));
  CHECK_FALSE(decoded.refused->text.empty());
}

}  // namespace

TEST_CASE("messages come out the same however the stream is cut") {
  const std::string stream = stream_of_everything();
  CHECK(rc::check([&](const std::vector<std::uint16_t>& sizes) {
    const Decoded decoded = decode(stream, {sizes.begin(), sizes.end()});
    RC_ASSERT(!decoded.refused);
    RC_ASSERT(decoded.messages.size() == 5U);
    const auto& second = std::get<ScanMessage>(decoded.messages[2]);
    RC_ASSERT(second.sequence == 2U);
    RC_ASSERT(second.scan.points_sensor == wall_points(25000));
    RC_ASSERT(second.scan.no_return_directions_sensor.size() == 3U);
    RC_ASSERT(std::get<PoseUpdateMessage>(decoded.messages[3]).T_fleet_map.translation.x() == 2.0);
    RC_ASSERT(std::get<ScanMessage>(decoded.messages[4]).scan.points_sensor.empty());
  }));
}

TEST_CASE("a stream cut at any byte gives the whole messages before it and waits") {
  const std::string stream = hello_frame() + scan_frame(1, 2) + pose_update_frame(1, 2.0);
  const std::size_t first = hello_frame().size();
  const std::size_t second = first + scan_frame(1, 2).size();
  for (std::size_t length = 0; length <= stream.size(); ++length) {
    const Decoded decoded = decode(stream.substr(0, length), {});
    CHECK_FALSE(decoded.refused.has_value());
    const std::size_t whole = (length >= first ? 1U : 0U) + (length >= second ? 1U : 0U) +
                              (length == stream.size() ? 1U : 0U);
    CHECK(decoded.messages.size() == whole);
  }
}

TEST_CASE("a changed byte never breaks the decoder") {
  const std::string stream = hello_frame() + scan_frame(1, 2) + pose_update_frame(1, 2.0);
  for (std::size_t i = 0; i < stream.size(); ++i) {
    for (const char value : {'\0', '\x7F', '\xFF'}) {
      std::string changed = stream;
      changed[i] = value;
      const Decoded decoded = decode(changed, {});
      CHECK(decoded.messages.size() <= 4);
    }
  }
}

TEST_CASE("defaults stand in for what a scan leaves out") {
  const Decoded decoded = decode(hello_frame() + scan_frame(1, 0), {});
  REQUIRE(decoded.messages.size() == 2);
  const Scan& scan = std::get<ScanMessage>(decoded.messages[1]).scan;
  CHECK(scan.T_base_sensor.checked().has_value());
  CHECK(scan.gravity_map == Eigen::Vector3d(0.0, 0.0, -1.0));
}

TEST_CASE("the first message must be a hello, of our version, once") {
  CHECK(decode(scan_frame(1), {}).refused->refusal == Refusal::kNoHello);
  CHECK(decode(hello_frame() + hello_frame(), {}).refused->refusal == Refusal::kSecondHello);
  ingest::IngestRequest request;
  request.mutable_hello()->set_protocol_version(2);
  CHECK(decode(framed(request.SerializeAsString()), {}).refused->refusal ==
        Refusal::kProtocolVersion);
  request.mutable_hello()->set_protocol_version(1);
  request.mutable_hello()->set_client(std::string(65, 'x'));
  CHECK(decode(framed(request.SerializeAsString()), {}).refused->refusal == Refusal::kLongText);
}

TEST_CASE("a header of no length, of too much, or no protobuf is refused") {
  CHECK(decode(std::string(4, '\0'), {}).refused->refusal == Refusal::kHeaderLength);
  CHECK(decode(std::string("\x01\x00\x01\x00", 4), {}).refused->refusal == Refusal::kHeaderLength);
  CHECK(decode("GET / HTTP/1.1\r\n\r\n", {}).refused->refusal == Refusal::kHeaderLength);
  CHECK(decode(framed("\xFF\xFF\xFF"), {}).refused->refusal == Refusal::kNotProtobuf);
  CHECK(decode(framed(std::string("\x7A\x00", 2)), {}).refused->refusal == Refusal::kNoBody);
}

TEST_CASE("what a scan announces is checked before anything is allocated") {
  auto request = scan_request(1, 100001);
  check_refused(request, Refusal::kTooManyPoints);
  request.mutable_scan()->set_points(0xFFFFFFFF);
  request.mutable_scan()->set_no_returns(0xFFFFFFFF);
  check_refused(request, Refusal::kTooManyPoints);
  request = scan_request(1, 1);
  request.mutable_scan()->set_sensor("sonar");
  check_refused(request, Refusal::kUnknownSensor);
}

TEST_CASE("extras must be few, named once and of a known type") {
  auto request = scan_request(1, 1);
  request.mutable_scan()->add_extras()->set_name("ring");
  check_refused(request, Refusal::kBadExtras);
  request.mutable_scan()->mutable_extras(0)->set_type(ingest::Extra::UINT16);
  request.mutable_scan()->add_extras()->CopyFrom(request.scan().extras(0));
  check_refused(request, Refusal::kBadExtras);
  request.mutable_scan()->mutable_extras(1)->set_name("stair");
  check_refused(request, Refusal::kBadExtras);
  request.mutable_scan()->clear_extras();
  for (int i = 0; i < 9; ++i) {
    request.mutable_scan()->add_extras()->set_name(std::to_string(i));
    request.mutable_scan()->mutable_extras(i)->set_type(ingest::Extra::UINT8);
  }
  check_refused(request, Refusal::kBadExtras);
}

TEST_CASE("memory grows with the bytes that came, not with those announced") {
  IngestDecoder decoder;
  const std::string stream = hello_frame() + framed(scan_request(1, 100000).SerializeAsString());
  for (std::size_t used = 0; used < stream.size();) {
    const auto buffer = decoder.buffer();
    const std::size_t count = std::min(buffer.size(), stream.size() - used);
    std::memcpy(buffer.data(), stream.data() + used, count);
    used += count;
    REQUIRE(decoder.commit(count, kLimits).has_value());
  }
  CHECK(decoder.is_within_message());
  CHECK(decoder.buffer().size() == IngestDecoder::kChunkBytes);
}

}  // namespace warren
