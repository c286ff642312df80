// SPDX-License-Identifier: Apache-2.0
#include "core/layer/range_coder.hpp"

#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

using Bits = std::vector<std::pair<bool, Probability>>;

// Bits that follow their probabilities or, by `percent_odd`, contradict them.
Bits random_bits(std::uint64_t seed, std::size_t count, std::uint32_t percent_odd) {
  test::Random random(seed);
  Bits bits;
  for (std::size_t i = 0; i < count; ++i) {
    const auto probability = static_cast<Probability>(1 + test::below(random, 65535));
    const bool likely = test::below(random, 65536) < probability;
    bits.emplace_back(likely != test::chance(random, percent_odd), probability);
  }
  return bits;
}

std::vector<std::uint8_t> encoded(const Bits& bits) {
  RangeEncoder encoder;
  for (const auto& [bit, probability] : bits) encoder.encode(bit, probability);
  return encoder.finish();
}

bool decodes_to(std::span<const std::uint8_t> bytes, const Bits& bits) {
  RangeDecoder decoder(bytes);
  for (const auto& [bit, probability] : bits) {
    if (decoder.decode(probability) != bit) return false;
  }
  return decoder.finished();
}

}  // namespace

TEST_CASE("bits come back whatever their probabilities") {
  CHECK(rc::check("round trip", [](std::uint64_t seed, std::uint16_t count) {
    const Bits bits = random_bits(seed, count % 3000, static_cast<std::uint32_t>(seed % 101));
    RC_ASSERT(decodes_to(encoded(bits), bits));
  }));
}

TEST_CASE("a carry reaches through a long run of ones") {
  // The low end creeps up to just below a carry, stays there, and then steps over it.
  for (int run = 1; run < 400; ++run) {
    Bits bits(static_cast<std::size_t>(run), {false, Probability{65535}});
    bits.insert(bits.end(), 40, {true, Probability{1}});
    bits.insert(bits.end(), 40, {false, Probability{65535}});
    REQUIRE(decodes_to(encoded(bits), bits));
  }
}

TEST_CASE("a likely bit costs little, an even one costs a bit") {
  CHECK(encoded(Bits(8000, {true, Probability{65000}})).size() < 20);
  const std::size_t even = encoded(random_bits(1, 0, 0)).size();
  CHECK(even == 1);
  Bits bits = random_bits(2, 8000, 0);
  for (auto& [bit, probability] : bits) probability = kEvenOdds;
  CHECK(encoded(bits).size() <= 1001);
}

TEST_CASE("an encoder put back goes on as if nothing had happened") {
  test::Random random(4);
  for (int round = 0; round < 300; ++round) {
    const Bits kept = random_bits(random(), test::below(random, 400), 20);
    const Bits undone = random_bits(random(), test::below(random, 400), 50);
    const Bits after = random_bits(random(), test::below(random, 400), 20);
    RangeEncoder encoder;
    for (const auto& [bit, probability] : kept) encoder.encode(bit, probability);
    const RangeEncoder::State state = encoder.state();
    const std::size_t size = encoder.bytes_if_finished();
    for (const auto& [bit, probability] : undone) encoder.encode(bit, probability);
    encoder.rewind(state);
    CHECK(encoder.bytes_if_finished() == size);
    for (const auto& [bit, probability] : after) encoder.encode(bit, probability);
    const std::size_t finished = encoder.bytes_if_finished();
    const auto bytes = encoder.finish();
    CHECK(bytes.size() == finished);
    Bits all = kept;
    all.insert(all.end(), after.begin(), after.end());
    REQUIRE(bytes == encoded(all));
  }
}

TEST_CASE("a decoder notices that its input ended too early or too late") {
  const Bits bits = random_bits(5, 2000, 0);
  std::vector<std::uint8_t> bytes = encoded(bits);
  bytes.push_back(0);
  CHECK_FALSE(decodes_to(bytes, bits));
  bytes.resize(bytes.size() / 2);
  RangeDecoder decoder(bytes);
  for (const auto& [bit, probability] : bits) decoder.decode(probability);
  CHECK(decoder.overrun());
}

TEST_CASE("adapting never reaches certainty") {
  Probability probability = kEvenOdds;
  for (int i = 0; i < 1000; ++i) adapt(probability, true);
  CHECK(probability == 65521);
  for (int i = 0; i < 1000; ++i) adapt(probability, false);
  CHECK(probability == 15);
}
