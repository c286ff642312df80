// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/session_keys.hpp"

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

constexpr BootId kA{1};
constexpr BootId kB{2};

struct Pair {
  PresharedKeys keys{Key{}};
  SessionKeys a{keys, kA, kB, 5};
  SessionKeys b{keys, kB, kA, 0};
};

TEST_CASE("a packet opens once, and only at the one for whom it was sealed") {
  Pair pair;
  const std::vector<std::uint8_t> content{1, 2, 3};
  const auto packet = pair.a.seal(content);
  const auto header = *read_packet_header(packet);
  CHECK(header.number == 5);
  CHECK(pair.b.open(header, packet) == content);
  CHECK(pair.b.open(header, packet).error() == Unused::kReplayed);

  SessionKeys other(pair.keys, BootId{3}, kA, 0);
  CHECK(other.open(header, packet).error() == Unused::kNotAuthentic);
}

TEST_CASE("a forged packet takes no number away") {
  Pair pair;
  const auto packet = pair.a.seal(std::vector<std::uint8_t>{1});
  auto forged = packet;
  forged.back() ^= 1;
  const auto header = *read_packet_header(packet);
  CHECK(pair.b.open(header, forged).error() == Unused::kNotAuthentic);
  CHECK(pair.b.open(header, packet).has_value());
}

TEST_CASE("beacons, group packets and pair packets do not take each other's numbers") {
  Pair pair;
  const Key group = pair.keys.group_key(kA);
  const std::vector<std::uint8_t> content{9};
  const PacketHeader beacon{PacketType::kBeacon, kA, 5};
  const PacketHeader group_header{PacketType::kGroup, kA, 5};
  CHECK(pair.b.open(beacon, seal(group, beacon, content)).has_value());
  CHECK(pair.b.open(group_header, seal(group, group_header, content)).has_value());
  const auto packet = pair.a.seal(content);
  CHECK(pair.b.open(*read_packet_header(packet), packet).has_value());
}

TEST_CASE("an overtaken packet is not the newest") {
  Pair pair;
  const auto first = pair.a.seal(std::vector<std::uint8_t>{1});
  const auto second = pair.a.seal(std::vector<std::uint8_t>{2});
  REQUIRE(pair.b.open(*read_packet_header(second), second));
  CHECK(pair.b.is_newest_pair(*read_packet_header(second)));
  REQUIRE(pair.b.open(*read_packet_header(first), first));
  CHECK_FALSE(pair.b.is_newest_pair(*read_packet_header(first)));
}

}  // namespace
}  // namespace warren::mesh
