// SPDX-License-Identifier: Apache-2.0
// The bytes of the format, from vectors.txt. check_vectors.py makes the same without our code.
#include <fstream>
#include <map>
#include <numeric>
#include <string>

#include <doctest/doctest.h>

#include "transport/wire/beacon.hpp"
#include "transport/wire/envelope.hpp"
#include "transport/wire/frames.hpp"

using namespace warren;
using namespace warren::mesh;

namespace {

using Bytes = std::vector<std::uint8_t>;
using Vectors = std::map<std::string, Bytes>;

Vectors read_vectors() {
  std::ifstream file(WARREN_SOURCE_DIR "/tests/transport/wire/vectors.txt");
  Vectors vectors;
  for (std::string name, hex; file >> name >> hex;) {
    Bytes& bytes = vectors[name];
    for (std::size_t i = 0; i < hex.size(); i += 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
    }
  }
  return vectors;
}

Key key_of(const Bytes& bytes) {
  Key key{};
  REQUIRE(bytes.size() == key.size());
  std::copy(bytes.begin(), bytes.end(), key.begin());
  return key;
}

const BootId kAnn{0x0123456789ABCDEF};
const BootId kBob{0xFEDCBA9876543210};
constexpr std::uint64_t kStream = 0x1122334455667788;

std::map<std::string, Frame> frames() {
  const Bytes map{1, 'm', 'a', 'p'};
  return {
      {"hello", HelloFrame{{3}, true}},
      {"ack",
       AckFrame{{{995, 1000}, {900, 990}, {0, 1}}, 0x12345678, Duration(1500), 14280, 0xFFFFFF00}},
      {"ping", PingFrame{4}},
      {"urgent", UrgentFrame{7, {'s', 't', 'o', 'p'}}},
      {"telemetry", TelemetryFrame{300, 5, {1, 2, 3}}},
      {"parcel_whole",
       ParcelFrame{{kStream, 2}, ParcelClass::kMessage, 2, 5, 0, {'h', 'e', 'l', 'l', 'o'}}},
      {"parcel_tail",
       ParcelFrame{{kStream, 200}, ParcelClass::kControl, 150, 1'000'000, 999'998, {'!', '!'}}},
      {"parcel_part",
       ParcelFrame{{kStream, 3}, ParcelClass::kMessage, 1, 300, 100, {'a', 'b', 'c'}}},
      {"parcel_asked", ParcelFrame{{kStream, 3}, ParcelClass::kMessage, 1, 300, 0, {}}},
      {"parcel_state", ParcelStateFrame{{kStream, 3}, false, {{0, 100}, {103, 200}}}},
      {"parcel_state_finished", ParcelStateFrame{{kStream, 2}, true, {}}},
      {"map_fresh", MapFrame{MapClass::kFresh, map}},
      {"map_backlog", MapFrame{MapClass::kBacklog, map}},
  };
}

}  // namespace

TEST_CASE("keys are those of the golden vectors") {
  const Vectors golden = read_vectors();
  Key fleet_key{};
  std::iota(fleet_key.begin(), fleet_key.end(), std::uint8_t{0});
  CHECK(key_of(golden.at("fleet_key")) == fleet_key);
  const PresharedKeys keys(fleet_key);
  CHECK(key_of(golden.at("group_key")) == keys.group_key(kAnn));
  CHECK(key_of(golden.at("pair_key")) == keys.pair_key(kAnn, kBob));
  CHECK(key_of(golden.at("pair_key_back")) == keys.pair_key(kBob, kAnn));
}

TEST_CASE("frames and beacons are those of the golden vectors, both ways") {
  const Vectors golden = read_vectors();
  for (const auto& entry : frames()) {
    const auto& name = entry.first;
    const auto& frame = entry.second;
    CAPTURE(name);
    Bytes content;
    append(content, frame);
    CHECK(content == golden.at(name));
    CHECK(read_frames(golden.at(name)) == std::vector<Frame>{frame});
  }
  const Beacon beacon{{3}, 300, 2000, {{0x76543210, 25}}};
  CHECK(encode(beacon) == golden.at("beacon"));
  CHECK(read_beacon(golden.at("beacon")) == beacon);
}

TEST_CASE("packets are those of the golden vectors, both ways") {
  const Vectors golden = read_vectors();
  Bytes pair;
  for (const char* name : {"hello", "ack", "urgent", "map_fresh"}) append(pair, frames().at(name));
  const auto check = [&](const char* key, const char* name, const PacketHeader& header,
                         const Bytes& content) {
    CAPTURE(name);
    const Bytes& packet = golden.at(name);
    CHECK(seal(key_of(golden.at(key)), header, content) == packet);
    CHECK(read_packet_header(packet) == header);
    CHECK(open(key_of(golden.at(key)), packet) == content);
  };
  check("group_key", "packet_beacon", {PacketType::kBeacon, kAnn, 1}, golden.at("beacon"));
  check("pair_key", "packet_pair", {PacketType::kPair, kAnn, 0x010203040506}, pair);
  check("pair_key_back", "packet_pair_back", {PacketType::kPair, kBob, 0}, {});
  check("group_key", "packet_group", {PacketType::kGroup, kAnn, 1}, golden.at("map_backlog"));
}
