// SPDX-License-Identifier: Apache-2.0
#include "core/layer/replica.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "core/layer/layer_counts.hpp"
#include "tests/core/layer/replica_steps.hpp"

using namespace warren;
using namespace warren::test;

TEST_CASE("a tick without changes is no revision") {
  Replica origin(kLayer, kDefaultResolution);
  CHECK(origin.publish({}) == Revision{0});
  const auto block = block_with(5, 3, VoxelCode::free());
  CHECK(origin.publish({{block}}) == Revision{1});
  CHECK(origin.publish({{block}}) == Revision{1});
  CHECK(origin.publish({{CodedBlock{6, {}}}}) == Revision{1});
  CHECK_FALSE(origin.encode({{}, {1}}));
}

TEST_CASE("a change of a cost or of a stair alone is told") {
  Replica origin(kLayer, kDefaultResolution);
  Replica copy(kLayer, kDefaultResolution);
  for (const auto& [cost, stair] : {std::pair{3, false}, {4, false}, {4, true}, {0, true}}) {
    const auto code = VoxelCode::occupied(static_cast<CostCode>(cost), stair);
    publish(origin, {block_with(9, 100, code)});
    CHECK(apply(copy, encoded(origin, copy.holdings().at(9).number)) == ApplyResult::kApplied);
    CHECK(copy.find(9)->codes.at(100) == code);
  }
}

TEST_CASE("a packet is news once, and a gap until what it builds on is held") {
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, {block_with(9, 1, VoxelCode::free())});
  const DiffPacket first = encoded(origin, 0);
  publish(origin, {block_with(9, 2, VoxelCode::free())});
  const DiffPacket second = encoded(origin, 1);
  const DiffPacket both = encoded(origin, 0);

  Replica copy(kLayer, kDefaultResolution);
  CHECK(apply(copy, second) == ApplyResult::kGap);
  CHECK(apply(copy, first) == ApplyResult::kApplied);
  CHECK(apply(copy, first) == ApplyResult::kDuplicate);
  CHECK(apply(copy, both) == ApplyResult::kApplied);
  CHECK(apply(copy, second) == ApplyResult::kDuplicate);
  CHECK(same(copy, origin, 9));
  CHECK(copy.apply_counts() == std::array<std::uint64_t, kApplyResults>{2, 2, 1, 0, 0, 0, 0});
}

TEST_CASE("silence about a block is knowledge") {
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, {block_with(9, 1, VoxelCode::free())});
  Replica copy(kLayer, kDefaultResolution);
  const DiffPacket nothing = encoded(origin, 0, {100, 200});
  CHECK(nothing.bytes.size() < 16);
  CHECK(apply(copy, nothing) == ApplyResult::kApplied);
  CHECK(copy.holdings().at(150) == Revision{1});
  CHECK(copy.holdings().at(9) == Revision{0});
}

TEST_CASE("the packets of one tick tile the key space and keep to their limit") {
  const Replica origin = noisy_layer(300);
  for (const std::size_t limit : {std::size_t{440}, std::size_t{1200}}) {
    const auto packets = encode_all(origin, {}, limit);
    CHECK(packets.size() > 20);
    Replica copy(kLayer, kDefaultResolution);
    BlockOrdinal next = 0;
    for (const DiffPacket& packet : packets) {
      CHECK(packet.bytes.size() <= limit);
      CHECK(packet.claim.keys.first == next);
      next = packet.claim.keys.end;
      CHECK(apply(copy, packet) == ApplyResult::kApplied);
    }
    CHECK(next == kOrdinalEnd);
    CHECK(copy.holdings() == Holdings(Revision{1}));
    origin.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock&) {
      CHECK(same(copy, origin, block));
      return true;
    });
  }
}

TEST_CASE("an emptied block is emptied at every copy, and passed on by them") {
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, {block_with(9, 1, VoxelCode::occupied(3, false))});
  Replica late(kLayer, kDefaultResolution);
  CHECK(apply(late, encoded(origin, 0)) == ApplyResult::kApplied);
  publish(origin, {{9, {}}});
  Replica relay(kLayer, kDefaultResolution);
  CHECK(apply(relay, encoded(origin, 0)) == ApplyResult::kApplied);
  CHECK(apply(late, encoded(relay, 1)) == ApplyResult::kApplied);
  CHECK(late.find(9)->codes.empty());
}

TEST_CASE("a block is told as a whole where two thirds of what is known of it are to be told") {
  const auto voxels_told = [](std::uint32_t changed) {
    BlockCodes codes;
    for (std::uint32_t i = 0; i < 10; ++i) codes.set(40 * i, VoxelCode::occupied(3, false));
    Replica origin(kLayer, kDefaultResolution);
    publish(origin, {{9, CodeBlock(codes)}});
    Replica copy(kLayer, kDefaultResolution);
    CHECK(apply(copy, encoded(origin, 0)) == ApplyResult::kApplied);
    for (std::uint32_t i = 0; i < changed; ++i) codes.set(40 * i, VoxelCode::occupied(4, false));
    publish(origin, {{9, CodeBlock(codes)}});
    const DiffPacket packet = encoded(origin, 1);
    CHECK(apply(copy, packet) == ApplyResult::kApplied);
    CHECK(same(copy, origin, 9));
    std::uint32_t told = 0;
    const auto diffs = read_blocks(*read_header(packet.bytes), packet.bytes);
    CodeBlock(diffs->front().codes).for_each_known([&](std::uint32_t, VoxelCode) { ++told; });
    return told;
  };
  CHECK(voxels_told(6) == 6);
  CHECK(voxels_told(7) == 10);
}

TEST_CASE("a relay tells no more of a block than changed since, though it was fed in bulk") {
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, {block_with(9, 1, VoxelCode::free())});
  publish(origin, {block_with(5000, 1, VoxelCode::free())});
  Replica relay(kLayer, kDefaultResolution);
  CHECK(apply(relay, encoded(origin, 0)) == ApplyResult::kApplied);
  std::vector<BlockOrdinal> told;
  relay.for_each_changed({}, {1}, [&](BlockOrdinal block, const LayerBlock&) {
    told.push_back(block);
    return true;
  });
  CHECK(told == std::vector<BlockOrdinal>{5000});
}

TEST_CASE("regions are found by their latest change") {
  Replica origin(kLayer, kDefaultResolution);
  const auto free = VoxelCode::free();
  publish(origin, {block_with(100, 1, free), block_with(600, 1, free), block_with(2000, 1, free)});
  publish(origin, {block_with(600, 2, free)});
  publish(origin, {block_with(101, 2, free)});
  using Regions = std::vector<KeyInterval>;
  const KeyInterval first{0, 512};
  const KeyInterval second{512, 1024};
  CHECK(origin.regions_by_change({1}, 16) == Regions{first, second});
  CHECK(origin.regions_by_change({2}, 16) == Regions{first});
  CHECK(origin.regions_by_change({0}, 2) == Regions{first, second});
  CHECK(origin.regions_by_change({0}, 16).size() == 3);
}

TEST_CASE("many regions are told in key order, few changed ones without looking at the rest") {
  Replica origin(kLayer, kDefaultResolution);
  std::vector<CodedBlock> everywhere;
  for (BlockOrdinal region = 0; region < 700; ++region) {
    everywhere.push_back(block_with(region << 9 | 7, 1, VoxelCode::free()));
  }
  publish(origin, everywhere);
  publish(origin, {block_with(650 << 9 | 7, 2, VoxelCode::free()), block_with(3, 2, {})});
  const auto told = [&](const KeyInterval& keys, Revision from) {
    std::vector<BlockOrdinal> blocks;
    origin.for_each_changed(keys, from, [&](BlockOrdinal block, const LayerBlock&) {
      blocks.push_back(block);
      return true;
    });
    return blocks;
  };
  const auto all = told({}, {0});
  CHECK(all.size() == 700);
  CHECK(std::is_sorted(all.begin(), all.end()));
  CHECK(told({512, 600 << 9}, {0}).size() == 599);
  CHECK(told({}, {1}) == std::vector<BlockOrdinal>{650 << 9 | 7});
}

TEST_CASE("forgotten blocks are empty, not held, and can be had again") {
  const Replica origin = noisy_layer(50);
  Replica copy(kLayer, kDefaultResolution);
  for (const auto& packet : encode_all(origin, {}, 1200)) apply(copy, packet);
  const std::size_t full = copy.memory_bytes();
  const KeyInterval half{kOrdinalEnd / 4, kOrdinalEnd / 2};
  CHECK(copy.forget(half));
  CHECK(copy.memory_bytes() < full);
  CHECK(copy.holdings().at(half.first) == Revision{0});
  copy.for_each_changed(half, {}, [](BlockOrdinal, const LayerBlock&) {
    FAIL("a block is left");
    return true;
  });
  for (const auto& packet : encode_all(origin, {}, 1200)) apply(copy, packet);
  CHECK(copy.holdings() == origin.holdings());
}

TEST_CASE("a copy takes at most 2.5 bytes per known voxel") {
  std::vector<CodedBlock> changes;
  std::uint64_t known = 0;
  for (std::int32_t x = 0; x < 100; ++x) {
    for (std::int32_t y = 0; y < 5; ++y) {
      BlockCodes codes;
      for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
        const VoxelKey at = place_of_morton9(place);
        if (at.z == 2) codes.set(place, VoxelCode::occupied(3, false));
        if (at.z > 2 && at.z < 6) codes.set(place, VoxelCode::free());
        known += at.z >= 2 && at.z < 6 ? 1 : 0;
      }
      changes.push_back({ordinal_of({x, y, 0}), CodeBlock(codes)});
    }
  }
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, changes);
  CHECK(origin.memory_bytes() < known * 5 / 2);
  Replica copy(kLayer, kDefaultResolution);
  for (const auto& packet : encode_all(origin, {}, 1200)) apply(copy, packet);
  CHECK(copy.memory_bytes() < known * 5 / 2);
}

TEST_CASE("whoever asked is told of blocks whose codes changed, once all is done") {
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, {block_with(9, 1, VoxelCode::free()), block_with(700, 1, VoxelCode::free())});
  Replica copy(kLayer, kDefaultResolution);
  std::vector<BlockOrdinal> told;
  copy.on_change([&](BlockOrdinal block) {
    told.push_back(block);
    CHECK(copy.holdings() == origin.holdings());
  });
  CHECK(apply(copy, encoded(origin, 0)) == ApplyResult::kApplied);
  CHECK(apply(copy, encoded(origin, 0)) == ApplyResult::kDuplicate);
  CHECK(told == std::vector<BlockOrdinal>{9, 700});

  told.clear();
  publish(origin, {block_with(700, 2, VoxelCode::free())});
  CHECK(apply(copy, encoded(origin, 0)) == ApplyResult::kApplied);
  CHECK(told == std::vector<BlockOrdinal>{700});
}

TEST_CASE("the origin's listener hears of what it publishes, and of what is forgotten") {
  Replica origin(kLayer, kDefaultResolution);
  std::vector<BlockOrdinal> told;
  origin.on_change([&](BlockOrdinal block) { told.push_back(block); });
  publish(origin, {block_with(9, 1, VoxelCode::free()), block_with(700, 1, VoxelCode::free())});
  CHECK(told == std::vector<BlockOrdinal>{9, 700});
  told.clear();
  origin.publish({{block_with(9, 1, VoxelCode::free())}});
  CHECK(told.empty());
  CHECK(origin.forget({0, 512}));
  CHECK(told == std::vector<BlockOrdinal>{9});
}

TEST_CASE("two replicas that differ walk down their digests to the block") {
  const Replica origin = noisy_layer(300);
  for (const bool rested : {false, true}) {
    Replica copy(kLayer, kDefaultResolution);
    for (const auto& packet : encode_all(origin, {}, 1200)) apply(copy, packet);
    const BlockOrdinal altered = copy.digest_blocks(copy.digest().regions()[5].ordinal)[0].ordinal;
    BlockCodes codes = copy.find(altered)->codes.unpack();
    codes.set(77, codes.at(77) == VoxelCode::free() ? VoxelCode{} : VoxelCode::free());
    publish(copy, {{altered, CodeBlock(codes)}});
    if (rested) copy.rest(copy.holdings().at(0), 1000);

    REQUIRE(copy.digest().root() != origin.digest().root());
    const auto regions = differing(origin.digest().regions(), copy.digest().regions());
    REQUIRE(regions == std::vector<std::uint64_t>{region_of(altered)});
    const auto mine = origin.digest_blocks(regions[0]);
    CHECK(differing(mine, copy.digest_blocks(regions[0])) == std::vector<std::uint64_t>{altered});
  }
}

TEST_CASE("the number of known voxels follows every change") {
  Replica origin = noisy_layer(40);
  Replica copy(kLayer, kDefaultResolution);
  const auto check = [](const Replica& layer) {
    const MapCounts counts = counts_of(layer);
    CHECK(layer.known_voxels() == counts.free + counts.occupied);
  };
  check(origin);
  CHECK(origin.known_voxels() > 0);
  for (const DiffPacket& packet : encode_all(origin, Revision{}, 1200)) apply(copy, packet);
  check(copy);
  CHECK(copy.known_voxels() == origin.known_voxels());
  std::vector<CodedBlock> emptied;
  origin.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock&) {
    emptied.push_back({block, {}});
    return emptied.size() < 20;
  });
  const Revision before = origin.holdings().at(0);
  publish(origin, emptied);
  check(origin);
  for (const DiffPacket& packet : encode_all(origin, before, 1200)) apply(copy, packet);
  check(copy);
  copy.rest(origin.holdings().at(0), 100);
  REQUIRE(copy.forget({0, kOrdinalEnd / 2}));
  check(copy);
  REQUIRE(copy.forget({}));
  CHECK(copy.known_voxels() == 0);
}
