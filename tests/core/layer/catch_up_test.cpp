// SPDX-License-Identifier: Apache-2.0
#include "core/layer/catch_up.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"
#include "tests/core/layer/replica_steps.hpp"

using namespace warren;
using test::block_with;
using test::publish;

namespace {

using Parts = std::vector<KeyInterval>;

const VoxelCode kFree = VoxelCode::free();

CodedBlock block_in(RegionOrdinal region, std::uint32_t place) {
  return block_with(region << 9 | 7, place, kFree);
}

// Every second region of this many has changed.
void publish_every_second(Replica& origin, RegionOrdinal regions) {
  std::vector<CodedBlock> blocks;
  for (RegionOrdinal i = 0; i < regions; ++i) blocks.push_back(block_in(2 * i, 1));
  publish(origin, blocks);
}

// Follows the parts until the copy holds all; the most intervals that it ever held.
std::size_t follow(const Replica& sender, Replica& copy) {
  std::size_t intervals = 0;
  for (KeyInterval keys : catch_up_parts(sender, copy.holdings().lowest({}))) {
    while (!keys.empty()) {
      const BlockOrdinal end = std::min(copy.holdings().interval_around(keys.first).end, keys.end);
      const Revision held = copy.holdings().at(keys.first);
      const auto packet = sender.encode({{keys.first, end}, held, kPacketBytesMin});
      if (packet) REQUIRE(copy.apply(copy.id(), packet->bytes) == ApplyResult::kApplied);
      keys.first = packet ? packet->claim.keys.end : end;
      intervals = std::max(intervals, copy.holdings().intervals().size());
    }
  }
  return intervals;
}

}  // namespace

TEST_CASE("a catch-up of few regions is one sweep") {
  Replica origin(LayerId{1, 1, 1}, kDefaultResolution);
  publish_every_second(origin, 7);
  CHECK(catch_up_parts(origin, {}) == Parts{{}});
  CHECK(catch_up_parts(origin, {1}) == Parts{{}});
}

TEST_CASE("a catch-up begins with an eighth of the regions, changed last, latest first") {
  Replica origin(LayerId{1, 1, 1}, kDefaultResolution);
  publish_every_second(origin, 24);
  publish(origin, {block_in(40, 2)});
  publish(origin, {block_in(8, 2)});
  publish(origin, {block_in(20, 2)});
  CHECK(catch_up_parts(origin, {}) ==
        Parts{keys_of_region(20), keys_of_region(8), keys_of_region(40), {}});
  // Of what was missed since, no eighth is left.
  CHECK(catch_up_parts(origin, {1}) == Parts{{}});
}

TEST_CASE("hot regions are one interval where nothing changed between them") {
  Replica origin(LayerId{1, 1, 1}, kDefaultResolution);
  publish_every_second(origin, 24);
  publish(origin, {block_in(10, 2)});
  publish(origin, {block_in(40, 2)});
  publish(origin, {block_in(8, 2)});
  const KeyInterval both{keys_of_region(8).first, keys_of_region(10).end};
  CHECK(catch_up_parts(origin, {}) == Parts{both, keys_of_region(40), {}});
}

TEST_CASE("a catch-up begins with sixteen regions at most") {
  Replica origin(LayerId{1, 1, 1}, kDefaultResolution);
  publish_every_second(origin, 400);
  for (RegionOrdinal i = 0; i < 20; ++i) publish(origin, {block_in(20 * i, 2)});
  const Parts parts = catch_up_parts(origin, {});
  CHECK(parts.size() == kHotRegionsMax + 1);
  CHECK(parts.front() == keys_of_region(20 * 19));
  CHECK(parts.back() == KeyInterval{});
}

TEST_CASE("who follows the parts of a catch-up ends equal to the sender") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    test::Random random(seed);
    Replica origin(LayerId{1, 1, seed}, kDefaultResolution);
    Replica copy(origin.id(), origin.resolution());
    const std::uint32_t joined_at = test::below(random, 12);
    for (std::uint32_t tick = 0; tick < 20; ++tick) {
      std::vector<CodedBlock> blocks;
      for (std::uint32_t region = 0; region < 200; ++region) {
        if (!test::chance(random, tick == 0 ? 80 : 15)) continue;
        const BlockOrdinal block = std::uint64_t{region} << 9 | test::below(random, 512);
        blocks.push_back({block, CodeBlock(test::random_codes(random))});
      }
      publish(origin, blocks);
      if (tick == joined_at) follow(origin, copy);
    }
    CHECK(catch_up_parts(origin, copy.holdings().lowest({})).size() > 1);
    CHECK(follow(origin, copy) <= Holdings::kIntervalsMax);
    CHECK(copy.holdings() == origin.holdings());
    CHECK(copy.digest().root() == origin.digest().root());
  }
}
