// SPDX-License-Identifier: Apache-2.0
#include "core/layer/diff_packet.hpp"

#include <algorithm>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

// A floor with a step in it, and air above: what maps are mostly made of.
BlockCodes floor_codes(test::Random& random) {
  BlockCodes codes;
  const auto height = static_cast<std::int32_t>(test::below(random, 8));
  const auto cost = static_cast<CostCode>(test::below(random, 14));
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelKey at = place_of_morton9(place);
    if (at.z > height) codes.set(place, VoxelCode::free());
    const auto here = static_cast<CostCode>(cost + test::below(random, 2));
    if (at.z == height) codes.set(place, VoxelCode::occupied(here, at.x > 4));
  }
  return codes;
}

BlockCodes codes_of_some_kind(test::Random& random) {
  switch (test::below(random, 4)) {
    case 0:
      return test::random_codes(random);
    case 1:
      return test::random_codes(random, 5);
    case 2:
      return {};
    default:
      return floor_codes(random);
  }
}

struct Content {
  Claim claim;
  std::vector<BlockDiff> diffs;
};

Content random_content(std::uint64_t seed) {
  test::Random random(seed);
  const std::uint32_t from = test::below(random, 300);
  Content content;
  content.claim = {{random() % 1000, kOrdinalEnd}, {from}, {from + 1 + test::below(random, 3)}};
  BlockOrdinal block = content.claim.keys.first;
  for (std::uint32_t count = test::below(random, 40); count > 0; --count) {
    BlockDiff diff{block, content.claim.to, test::chance(random, 20), codes_of_some_kind(random)};
    diff.changed_at.number -= test::below(random, content.claim.to.number - from);
    content.diffs.push_back(diff);
    block += 1 + (random() % kOrdinalEnd / 64 >> test::below(random, 39));
  }
  return content;
}

// As many of the blocks as fit.
DiffPacket written(Content& content, std::size_t limit_bytes) {
  PacketWriter writer(content.claim, limit_bytes);
  for (const BlockDiff& diff : content.diffs) {
    if (!writer.add(diff)) break;
  }
  content.diffs.resize(writer.blocks());
  return writer.finish(kOrdinalEnd);
}

tl::expected<std::vector<BlockDiff>, PacketError> read(std::span<const std::uint8_t> packet) {
  const auto header = read_header(packet);
  if (!header) return tl::unexpected(header.error());
  return read_blocks(*header, packet);
}

// Whatever was read keeps what a reader promises.
void check_promises(std::span<const std::uint8_t> packet) {
  const auto diffs = read(packet);
  if (!diffs) return;
  REQUIRE(diffs->size() <= kBlocksPerPacketMax);
  const Claim claim = read_header(packet)->claim;
  for (const BlockDiff& diff : *diffs) {
    REQUIRE(claim.keys.contains(diff.block));
    REQUIRE(claim.from < diff.changed_at);
    REQUIRE(diff.changed_at <= claim.to);
    REQUIRE(CodeBlock(diff.codes).unpack() == diff.codes);
  }
  REQUIRE(std::is_sorted(diffs->begin(), diffs->end(), [](const auto& a, const auto& b) {
    return a.block <= b.block && a.block != b.block;
  }));
}

}  // namespace

TEST_CASE("blocks come back from their packet, and no packet is longer than its limit") {
  CHECK(rc::check("round trip", [](std::uint64_t seed) {
    Content content = random_content(seed);
    const std::size_t limit = kPacketBytesMin + seed % 961;
    const DiffPacket packet = written(content, limit);
    RC_ASSERT(packet.bytes.size() <= limit);
    const auto diffs = read(packet.bytes);
    RC_ASSERT(diffs.has_value());
    RC_ASSERT(diffs->size() == content.diffs.size());
    for (std::size_t i = 0; i < diffs->size(); ++i) RC_ASSERT((*diffs)[i] == content.diffs[i]);
  }));
}

TEST_CASE("a packet holds at least one block, be it noise") {
  test::Random random(1);
  for (int round = 0; round < 500; ++round) {
    const Claim claim{{kOrdinalEnd / 2 - 1, kOrdinalEnd}, {1}, {0xFFFFFFFF}};
    BlockDiff diff{kOrdinalEnd - 1, {0x80000000}, true, {}};
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      const bool occupied = test::chance(random, static_cast<std::uint32_t>(round % 101));
      const auto cost = static_cast<CostCode>(test::below(random, 16));
      const bool stair = test::chance(random, 50);
      if (occupied) diff.codes.set(place, VoxelCode::occupied(cost, stair));
    }
    PacketWriter writer(claim, kPacketBytesMin);
    REQUIRE(writer.add(diff));
    const DiffPacket packet = writer.finish(kOrdinalEnd);
    REQUIRE(packet.bytes.size() <= kPacketBytesMin);
    const auto diffs = read(packet.bytes);
    REQUIRE(diffs);
    REQUIRE(diffs->size() == 1);
    REQUIRE((*diffs)[0] == diff);
  }
}

TEST_CASE("a block that does not fit leaves no trace in the packet") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Content content = random_content(seed);
    const DiffPacket packet = written(content, kPacketBytesMin);
    CHECK(written(content, kPacketBytesMin).bytes == packet.bytes);
  }
}

TEST_CASE("a packet cut anywhere is malformed") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Content content = random_content(seed);
    const DiffPacket packet = written(content, 600);
    for (std::size_t length = 0; length < packet.bytes.size(); ++length) {
      const auto diffs = read(std::span(packet.bytes).first(length));
      REQUIRE_FALSE(diffs);
      REQUIRE(diffs.error() == PacketError::kMalformed);
    }
    auto longer = packet.bytes;
    longer.push_back(0);
    REQUIRE_FALSE(read(longer));
  }
}

TEST_CASE("a flipped bit does no harm to the reader") {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Content content = random_content(seed);
    DiffPacket packet = written(content, kPacketBytesMin);
    for (std::size_t bit = 0; bit < packet.bytes.size() * 8; ++bit) {
      auto& byte = packet.bytes[bit / 8];
      byte = static_cast<std::uint8_t>(byte ^ 1U << bit % 8);
      check_promises(packet.bytes);
      byte = static_cast<std::uint8_t>(byte ^ 1U << bit % 8);
    }
  }
}

TEST_CASE("random bytes do no harm to the reader") {
  test::Random random(3);
  for (int round = 0; round < 3000; ++round) {
    auto bytes = write_header({{0, kOrdinalEnd}, {0}, {1 + test::below(random, 9)}});
    const std::size_t size = bytes.size() + test::below(random, 1400);
    while (bytes.size() < size) bytes.push_back(static_cast<std::uint8_t>(random()));
    check_promises(bytes);
  }
  for (const std::uint8_t same : {std::uint8_t{0x00}, std::uint8_t{0xFF}}) {
    auto bytes = write_header({{0, kOrdinalEnd}, {0}, {1}});
    bytes.insert(bytes.end(), 1400, same);
    check_promises(bytes);
  }
}

// FNV-1a, 64 bits.
struct Hash {
  void add(std::uint8_t byte) { value = (value ^ byte) * 0x100000001B3; }
  std::uint64_t value = 0xCBF29CE484222325;
};

TEST_CASE("the priors of packet version 1 are the same from every compiler") {
  REQUIRE(kPacketVersion == 1);
  REQUIRE(diff_priors().size() == 45346);
  Hash hash;
  for (const Probability prior : diff_priors()) {
    REQUIRE(prior == prior_of(static_cast<std::uint8_t>(prior >> 8)));
    hash.add(static_cast<std::uint8_t>(prior >> 8));
  }
  CHECK(hash.value == 4691240720737257377U);
}

TEST_CASE("the bytes of a packet are the same from every compiler") {
  Hash hash;
  std::size_t bytes = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Content content = random_content(seed);
    const DiffPacket packet = written(content, 1400);
    for (const std::uint8_t byte : packet.bytes) hash.add(byte);
    bytes += packet.bytes.size();
  }
  CHECK(bytes == 18320);
  CHECK(hash.value == 1512009631349343422U);
}
