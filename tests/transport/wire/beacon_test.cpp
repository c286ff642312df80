// SPDX-License-Identifier: Apache-2.0
#include "transport/wire/beacon.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/transport/wire/random_frames.hpp"

using namespace warren;
using namespace warren::mesh;

TEST_CASE("a beacon comes back from its bytes") {
  CHECK(rc::check("round trip", [](std::uint64_t seed) {
    test::Random random(seed);
    const Beacon beacon = test::random_beacon(random);
    RC_ASSERT(read_beacon(encode(beacon)) == beacon);
  }));
}

TEST_CASE("a beacon has one form: a bit changed means refusal or another beacon") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    test::Random random(seed);
    const Beacon beacon = test::random_beacon(random);
    const auto bytes = encode(beacon);
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
      auto flipped = bytes;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1U << bit % 8);
      const auto read = read_beacon(flipped);
      if (!read) continue;
      REQUIRE(*read != beacon);
      REQUIRE(encode(*read) == flipped);
    }
  }
}

TEST_CASE("a beacon that is cut short is refused, or says less of whom it hears") {
  test::Random random(1);
  Beacon beacon = test::random_beacon(random);
  beacon.heard.resize(Beacon::kHeardMax);
  const auto bytes = encode(beacon);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const auto read = read_beacon(std::span(bytes).first(length));
    CHECK(read.has_value() == ((bytes.size() - length) % 5 == 0 && length >= bytes.size() - 40));
  }
}

TEST_CASE("limits of a beacon") {
  auto bytes = encode({{1}, 2, 3, std::vector<Beacon::Heard>(Beacon::kHeardMax)});
  CHECK(bytes.size() == 43);
  bytes.resize(bytes.size() + 5);
  CHECK_FALSE(read_beacon(bytes));
  using Bytes = std::vector<std::uint8_t>;
  CHECK(read_beacon(Bytes{1, 2, 0xFF, 0xFF, 0x03}));
  CHECK_FALSE(read_beacon(Bytes{1, 2, 0x80, 0x80, 0x04}));
  CHECK_FALSE(read_beacon(Bytes{1, 2, 0x83, 0x00}));
}
