// SPDX-License-Identifier: Apache-2.0
#include "core/layer/packet_header.hpp"

#include <algorithm>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

Claim random_claim(std::uint64_t seed) {
  test::Random random(seed);
  const auto key = [&] { return (random() % kOrdinalEnd) >> test::below(random, 40); };
  const BlockOrdinal a = key();
  const BlockOrdinal b = test::chance(random, 20) ? kOrdinalEnd : key() << test::below(random, 8);
  const auto number = [&] {
    return static_cast<std::uint32_t>(random()) >> test::below(random, 32);
  };
  const std::uint32_t from = std::min(number(), 0xFFFFFFFEU);
  const std::uint32_t to = from + 1 + number() % (0xFFFFFFFFU - from);
  return {{std::min(a, b), std::min(kOrdinalEnd, std::max(a, b) + 1)}, {from}, {to}};
}

}  // namespace

TEST_CASE("every claim comes back from its header, and no header is longer than it is said to be") {
  CHECK(rc::check("round trip", [](std::uint64_t seed) {
    const Claim claim = random_claim(seed);
    const auto bytes = write_header(claim);
    RC_ASSERT(bytes.size() <= header_bytes_max(claim));
    const auto header = read_header(bytes);
    RC_ASSERT(header.has_value());
    RC_ASSERT(header->claim == claim);
    RC_ASSERT(header->bytes == bytes.size());
  }));
}

TEST_CASE("the bytes of a header are what the format says") {
  using Bytes = std::vector<std::uint8_t>;
  CHECK(write_header({{0, kOrdinalEnd}, {0}, {1}}) == Bytes{1, 0x00, 0, 0});
  CHECK(write_header({{0x4000000000, 0x4700001200}, {300}, {302}}) ==
        Bytes{1, 0x41, 0x40, 0x47, 0x00, 0x00, 0x12, 0xAC, 0x02, 1});
}

TEST_CASE("a claim has one header: any other bytes are refused or mean another claim") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const auto bytes = write_header(random_claim(seed));
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const auto cut = read_header(std::span(bytes).first(length));
      REQUIRE_FALSE(cut);
      REQUIRE(cut.error() == PacketError::kMalformed);
    }
    for (std::size_t bit = 8; bit < bytes.size() * 8; ++bit) {
      auto flipped = bytes;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1U << bit % 8);
      if (const auto header = read_header(flipped)) {
        REQUIRE(header->claim.valid());
        REQUIRE(write_header(header->claim) ==
                std::vector(flipped.begin(),
                            flipped.begin() + static_cast<std::ptrdiff_t>(header->bytes)));
      }
    }
  }
}

TEST_CASE("an unknown version is told apart") {
  auto bytes = write_header({{0, 9}, {0}, {1}});
  bytes[0] = kPacketVersion + 1;
  CHECK(read_header(bytes).error() == PacketError::kUnknownVersion);
}
