// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/block_bytes.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/voxel/self_map.hpp"
#include "daemon/store/mask_bytes.hpp"
#include "daemon/store/sealed_bytes.hpp"
#include "daemon/store/value_bytes.hpp"
#include "tests/core/layer/random_codes.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;

namespace {

// Masks as maps have them: whole words and bytes more often than noise.
VoxelMask some_mask(test::Random& random) {
  VoxelMask mask{};
  for (std::uint64_t& word : mask) {
    for (int byte = 0; byte < 64; byte += 8) {
      const std::uint32_t kind = test::below(random, 4);
      const std::uint64_t bits = kind == 0 ? 0 : kind == 1 ? 0xFF : random() & 0xFF;
      word |= bits << byte;
    }
    if (test::chance(random, 30)) word = 0;
    if (test::chance(random, 30)) word = kFullCell;
  }
  return mask;
}

std::vector<BlockState> states_of_a_walk() {
  SelfMap map(SelfMapConfig{});
  for (const auto& scan : test::walk_through_room(test::Room{}, test::Lidar{}, 12)) {
    map.integrate(scan.view());
    std::vector<VoxelCost> costs;
    map.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float) {
      if (state == VoxelState::kOccupied && (key.x + key.y) % 3 == 0) {
        costs.push_back({key, static_cast<float>(key.x & 15) / 16.0F, 0.9F});
      }
    });
    map.fuse_costs(costs);
  }
  std::vector<BlockState> states;
  for (const BlockKey& key : map.blocks_changed_since(0)) states.push_back(*map.export_block(key));
  return states;
}

}  // namespace

TEST_CASE("the checksum is CRC-32C") {
  const std::string digits = "123456789";
  const std::vector<std::uint8_t> bytes(digits.begin(), digits.end());
  CHECK(crc32c(bytes) == 0xE3069283U);  // the check value of the catalogues
  CHECK(crc32c(std::span(bytes).subspan(3), crc32c(std::span(bytes).first(3))) == crc32c(bytes));
}

TEST_CASE("a seal is broken by another key, and by any bit of key or bytes") {
  std::vector<std::uint8_t> bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const std::vector<std::uint8_t> content = bytes;
  seal(42, bytes);
  const auto read = unsealed(42, bytes);
  REQUIRE(read);
  CHECK(std::vector<std::uint8_t>(read->begin(), read->end()) == content);
  CHECK_FALSE(unsealed(43, bytes));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1U << bit % 8);
    CHECK_FALSE(unsealed(42, bytes));
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1U << bit % 8);
  }
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CHECK_FALSE(unsealed(42, std::span(bytes).first(length)));
  }
}

TEST_CASE("masks come back") {
  CHECK(rc::check("as they were", [] {
    test::Random random(*rc::gen::arbitrary<std::uint32_t>());
    const VoxelMask mask = some_mask(random);
    ByteWriter writer;
    write_mask(mask, writer);
    const auto bytes = writer.take();
    RC_ASSERT(bytes.size() <= 82U);
    ByteReader reader(bytes);
    RC_ASSERT(read_mask(reader) == mask);
    RC_ASSERT(reader.left() == 0U);
  }));
}

TEST_CASE("numbers that repeat come back, be they few or many") {
  CHECK(rc::check("as they were", [] {
    const auto kinds = *rc::gen::inRange(1, 600);
    const auto numbers = *rc::gen::container<std::vector<std::uint16_t>>(
        rc::gen::map(rc::gen::inRange(0, kinds), [](int n) { return std::uint16_t(n * 97); }));
    ByteWriter writer;
    write_values<std::uint16_t>(numbers, writer);
    const auto bytes = writer.take();
    ByteReader reader(bytes);
    RC_ASSERT(read_values<std::uint16_t>(numbers.size(), reader) == numbers);
    RC_ASSERT(reader.left() == 0U);
  }));
}

TEST_CASE("a layer's block comes back") {
  CHECK(rc::check("codes and age", [] {
    test::Random random(*rc::gen::arbitrary<std::uint32_t>());
    const BlockCodes codes = test::random_codes(random, test::below(random, 101));
    const StoredBlock block{
        random() % kOrdinalEnd, {1 + test::below(random, 1000)}, CodeBlock(codes)};
    const auto read = decode_block(block.block, encode_block(block));
    RC_ASSERT(read.has_value());
    RC_ASSERT(read->changed_at == block.changed_at);
    RC_ASSERT(read->codes == block.codes);
  }));
}

TEST_CASE("a self-map's block comes back to the bit") {
  const auto states = states_of_a_walk();
  REQUIRE(states.size() > 100);
  for (const BlockState& state : states) {
    CHECK(decode_self_block(ordinal_of(state.key), encode_self_block(state)) == state);
  }
}

TEST_CASE("altered or cut blocks are refused, or are blocks with one encoding") {
  test::Random random(7);
  const BlockState state = states_of_a_walk().front();
  const StoredBlock block{5, {9}, CodeBlock(test::random_codes(random, 70))};
  const auto self_bytes = encode_self_block(state);
  const auto bytes = encode_block(block);
  for (std::size_t length = 0; length < self_bytes.size(); ++length) {
    CHECK_FALSE(decode_self_block(ordinal_of(state.key), std::span(self_bytes).first(length)));
  }
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CHECK_FALSE(decode_block(5, std::span(bytes).first(length)));
  }
  for (int i = 0; i < 5000; ++i) {
    auto altered = self_bytes;
    altered[random() % altered.size()] = static_cast<std::uint8_t>(random());
    if (const auto read = decode_self_block(ordinal_of(state.key), altered)) {
      CHECK(encode_self_block(*read) == altered);
    }
    auto altered_codes = bytes;
    altered_codes[random() % altered_codes.size()] = static_cast<std::uint8_t>(random());
    if (const auto read = decode_block(5, altered_codes)) {
      CHECK(encode_block(*read) == altered_codes);
    }
  }
}
