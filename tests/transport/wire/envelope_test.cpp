// SPDX-License-Identifier: Apache-2.0
#include "transport/wire/envelope.hpp"

#include <set>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/transport/wire/random_frames.hpp"

using namespace warren;
using namespace warren::mesh;

namespace {

using Bytes = std::vector<std::uint8_t>;

const Key kFleetKey{1, 2, 3};
const BootId kAnn{0x0123456789ABCDEF};
const BootId kBob{0xFEDCBA9876543210};

PacketHeader random_header(test::Random& random) {
  return {static_cast<PacketType>(random() % 3),
          {random()},
          test::any_up_to(random, kPacketNumberEnd - 1)};
}

}  // namespace

TEST_CASE("what is sealed opens with the same key, and its header can be read without") {
  CHECK(rc::check("round trip", [](std::uint64_t seed) {
    test::Random random(seed);
    const PacketHeader header = random_header(random);
    const Key key = PresharedKeys(kFleetKey).group_key(header.sender);
    const Bytes content = test::random_bytes(random, random() % 1500);
    const Bytes packet = seal(key, header, content);
    RC_ASSERT(packet.size() == content.size() + kEnvelopeBytes);
    RC_ASSERT(read_packet_header(packet) == header);
    RC_ASSERT(open(key, packet) == content);
  }));
}

TEST_CASE("a packet with any bit changed, cut short or made longer does not open") {
  test::Random random(1);
  const Key key = PresharedKeys(kFleetKey).pair_key(kAnn, kBob);
  for (const std::size_t size : {0U, 1U, 100U}) {
    const Bytes packet = seal(key, random_header(random), test::random_bytes(random, size));
    for (std::size_t bit = 0; bit < packet.size() * 8; ++bit) {
      Bytes flipped = packet;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1U << bit % 8);
      REQUIRE_FALSE(open(key, flipped));
    }
    for (std::size_t length = 0; length < packet.size(); ++length) {
      REQUIRE_FALSE(open(key, std::span(packet).first(length)));
    }
    Bytes longer = packet;
    longer.push_back(0);
    REQUIRE_FALSE(open(key, longer));
  }
}

TEST_CASE("random bytes do not open") {
  const Key key = PresharedKeys(kFleetKey).pair_key(kAnn, kBob);
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    test::Random random(seed);
    Bytes packet = test::random_bytes(random, random() % 80);
    if (packet.size() > 1) packet[0] = 0x11, packet[1] = 0;
    REQUIRE(read_packet_header(packet).has_value() == (packet.size() >= kEnvelopeBytes));
    REQUIRE_FALSE(open(key, packet));
  }
}

TEST_CASE("other versions, unknown types and the reserved byte are refused") {
  Bytes packet = seal({}, {PacketType::kGroup, kAnn, 5}, {});
  for (int first = 0; first < 256; ++first) {
    packet[0] = static_cast<std::uint8_t>(first);
    CHECK(read_packet_header(packet).has_value() == (first >= 0x10 && first <= 0x12));
  }
  packet[0] = 0x10;
  for (int second = 1; second < 256; ++second) {
    packet[1] = static_cast<std::uint8_t>(second);
    CHECK_FALSE(read_packet_header(packet));
  }
}

TEST_CASE("each sender, direction, life and purpose has a key of its own") {
  const PresharedKeys keys(kFleetKey);
  const PresharedKeys others(Key{1, 2, 4});
  const BootId ann_again{kAnn.bits + 1};
  const std::set<Key> all{keys.group_key(kAnn),           keys.group_key(kBob),
                          keys.group_key(ann_again),      keys.pair_key(kAnn, kBob),
                          keys.pair_key(kBob, kAnn),      keys.pair_key(ann_again, kBob),
                          keys.pair_key(kBob, ann_again), keys.pair_key(kAnn, kAnn),
                          others.group_key(kAnn),         others.pair_key(kAnn, kBob)};
  CHECK(all.size() == 10);
  CHECK(keys.pair_key(kAnn, kBob) == PresharedKeys(kFleetKey).pair_key(kAnn, kBob));
}

TEST_CASE("beacons and group packets share a key and may have the same number, but not the nonce") {
  const Key key = PresharedKeys(kFleetKey).group_key(kAnn);
  const Bytes content(100);
  const Bytes beacon = seal(key, {PacketType::kBeacon, kAnn, 9}, content);
  const Bytes group = seal(key, {PacketType::kGroup, kAnn, 9}, content);
  const auto sealed = [](const Bytes& packet) {
    return Bytes(packet.begin() + kHeaderBytes, packet.end() - kTagBytes);
  };
  CHECK(sealed(beacon) != sealed(group));
}
