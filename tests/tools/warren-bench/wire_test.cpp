// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "core/voxel/morton.hpp"
#include "tests/core/layer/random_codes.hpp"
#include "tools/warren-bench/octomap_codes_peer.hpp"
#include "tools/warren-bench/wire_bench.hpp"
#include "tools/warren-bench/wire_sweep.hpp"

using namespace warren;

namespace {

constexpr LayerId kLayer{1, 1, 1};
constexpr std::uint32_t kBlocks = 300;

// Every tick some blocks get other codes; no voxel is ever unknown again.
WireTape random_tape(std::size_t ticks) {
  test::Random random(1);
  std::vector<BlockCodes> blocks(kBlocks);
  WireTape tape;
  for (std::size_t i = 0; i < ticks; ++i) {
    auto& tick = tape.ticks.emplace_back();
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
      if (!test::chance(random, 20)) continue;
      blocks[block].overlay(test::random_codes(random, 30));
      tick.push_back({BlockOrdinal{block} * 97, CodeBlock(blocks[block])});
    }
  }
  return tape;
}

ScanSequence scans_at(std::vector<std::optional<double>> times_s) {
  ScanSequence sequence;
  for (const auto& time_s : times_s) sequence.scans.push_back({{}, {}, time_s});
  return sequence;
}

WireOptions options_of(double tick_s, double rate_hz) {
  WireOptions options;
  options.tick_s = tick_s;
  options.rate_hz = rate_hz;
  return options;
}

}  // namespace

TEST_CASE("a tick spans as many scans as the rate says, or their own times") {
  const ScanSequence untimed = scans_at({{}, {}, {}});
  CHECK(scans_per_tick(untimed, options_of(10.0, 1.0)) == 10);
  CHECK(scans_per_tick(untimed, options_of(1.0, 10.0)) == 10);
  CHECK(scans_per_tick(untimed, options_of(0.1, 1.0)) == 1);
  const ScanSequence timed = scans_at({100.0, 100.2, 100.4});
  CHECK(scans_per_tick(timed, options_of(10.0, 1.0)) == 50);
  const ScanSequence half_timed = scans_at({100.0, 100.2, {}});
  CHECK(scans_per_tick(half_timed, options_of(10.0, 1.0)) == 10);
}

TEST_CASE("a live pass counts the voxels whose codes changed and makes an equal copy") {
  const WireTape tape = random_tape(5);
  Replica origin(kLayer, kDefaultResolution);
  Replica copy(kLayer, kDefaultResolution);
  const auto result = run_live(tape, options_of(1.0, 1.0), origin, copy);
  REQUIRE(result);
  Replica again(kLayer, kDefaultResolution);
  std::uint64_t changed = 0;
  std::uint64_t bytes = 0;
  for (const auto& tick : tape.ticks) {
    for (const CodedBlock& block : tick) {
      const LayerBlock* const before = again.find(block.block);
      for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
        const VoxelCode was = before != nullptr ? before->codes.at(place) : VoxelCode{};
        if (block.codes.at(place) != was) ++changed;
      }
    }
    const Revision from = again.holdings().at(0);
    again.publish(tick);
    bytes += bytes_of(sweep(again, from, 1200));
  }
  CHECK(result->voxels_changed == changed);
  CHECK(result->ours.bytes == bytes);
  CHECK(copy.digest().root() == origin.digest().root());
}

TEST_CASE("a copy that missed nothing costs nothing and one that missed all costs a snapshot") {
  const WireTape tape = random_tape(10);
  Replica origin(kLayer, kDefaultResolution);
  for (const auto& tick : tape.ticks) origin.publish(tick);
  const auto results = bench_catch_up(tape, origin, options_of(1.0, 1.0));
  REQUIRE(results);
  REQUIRE(results->size() == 5);
  CHECK(results->front().missed_share == 0.0);
  CHECK(results->front().bytes == 0);
  CHECK(results->front().relay_bytes == 0);
  for (std::size_t i = 1; i < results->size(); ++i) {
    CHECK((*results)[i].bytes > 0);
    CHECK((*results)[i].snapshot_bytes >= (*results)[i - 1].snapshot_bytes);
  }
}

TEST_CASE("catching up raises a copy with holes to the source") {
  const WireTape tape = random_tape(6);
  Replica origin(kLayer, kDefaultResolution);
  origin.publish(tape.ticks[0]);
  Replica copy(kLayer, kDefaultResolution);
  // Half of the first tick arrives, then the origin goes on.
  auto packets = sweep(origin, {}, 440);
  packets.resize(packets.size() / 2);
  REQUIRE(apply_all(copy, packets));
  for (std::size_t i = 1; i < tape.ticks.size(); ++i) origin.publish(tape.ticks[i]);
  REQUIRE_FALSE(same_blocks(origin, copy));
  CHECK(catch_up(origin, copy, 440));
  CHECK(same_blocks(origin, copy));
  CHECK(copy.holdings() == origin.holdings());
  CHECK(catch_up(origin, copy, 440) == 0);
}

TEST_CASE("sameness of blocks is seen from both sides") {
  const WireTape tape = random_tape(1);
  Replica full(kLayer, kDefaultResolution);
  full.publish(tape.ticks[0]);
  const Replica empty(kLayer, kDefaultResolution);
  CHECK(same_blocks(full, full));
  CHECK_FALSE(same_blocks(full, empty));
  CHECK_FALSE(same_blocks(empty, full));
}

TEST_CASE("queries are measured where the merge-map and OctoMap agree, and not without a map") {
  const WireTape tape = random_tape(2);
  Replica layer(kLayer, kDefaultResolution);
  CHECK_FALSE(bench_query(layer, 0.15));
  for (const auto& tick : tape.ticks) layer.publish(tick);
  const auto cost = bench_query(layer, 0.15);
  REQUIRE(cost);
  CHECK(cost->ours_ns > 0.0);
  CHECK(cost->octomap_ns > 0.0);
  CHECK(cost->known_share > 0.0);
  CHECK(cost->known_share <= 1.0);
}

TEST_CASE("OctoMap as a receiver knows what the diff-maps told, in both modes") {
  const std::vector<ChangedVoxel> voxels = {{morton_of({-3, 0, 5}), VoxelCode::free()},
                                            {morton_of({-2, 0, 5}), VoxelCode::occupied(7, false)}};
  for (const bool lazy : {false, true}) {
    OctomapCodesPeer peer(0.15, lazy);
    peer.insert(voxels);
    peer.finish();
    CHECK(peer.search({-3, 0, 5}) == VoxelState::kFree);
    CHECK(peer.search({-2, 0, 5}) == VoxelState::kOccupied);
    CHECK(peer.search({-1, 0, 5}) == VoxelState::kUnknown);
  }
}
