// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/fleet_tape.hpp"

#include <set>

#include <doctest/doctest.h>

#include "core/voxel/key.hpp"

using namespace warren;

namespace {

CodedBlock block_at(std::int32_t x) { return {ordinal_of({x, 1, 2}), {}}; }

// From block -3 to block 9: two regions long.
FleetTape short_tape() {
  FleetTape tape;
  tape.resolution_m = 0.5;
  tape.ticks = {{{block_at(-3), block_at(-2)}, {1.0, 2.0, 3.0}},
                {{block_at(4)}, {4.0, 5.0, 6.0}},
                {{block_at(9)}, {7.0, 8.0, 9.0}}};
  return tape;
}

std::int32_t first_x(const FleetTape::Tick& tick) {
  return block_key_of(tick.blocks.at(0).block).x;
}

}  // namespace

TEST_CASE("a tape begins where it is told to, and goes on east of what it told before") {
  const FleetTape tape = short_tape();
  TapePlay play(tape, 1);
  CHECK(first_x(play.next()) == 4);
  CHECK(first_x(play.next()) == 9);
  const FleetTape::Tick again = play.next();
  CHECK(first_x(again) == -3 + 16);
  CHECK(block_key_of(again.blocks.at(1).block).x == -2 + 16);
  CHECK(block_key_of(again.blocks.at(0).block).y == 1);
  // 16 blocks of 8 voxels of half a metre.
  CHECK(again.position_layer == Eigen::Vector3d(1.0 + 64.0, 2.0, 3.0));
  CHECK(first_x(play.next()) == 4 + 16);
  CHECK(first_x(play.next()) == 9 + 16);
  CHECK(first_x(play.next()) == -3 + 32);
}

TEST_CASE("a tape can be played until the key space ends, and no place comes twice") {
  const FleetTape tape = short_tape();
  TapePlay play(tape, 2);
  const std::size_t ticks = play.ticks_max();
  CHECK(ticks == 3 * ((kKeyMax / kBlockEdge - 9) / 16 + 1) - 2);
  std::set<BlockOrdinal> told;
  std::int32_t highest = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    for (const CodedBlock& block : play.next().blocks) {
      CHECK(told.insert(block.block).second);
      highest = std::max(highest, block_key_of(block.block).x);
    }
  }
  CHECK(highest <= kKeyMax / kBlockEdge);
  CHECK(highest + 16 > kKeyMax / kBlockEdge);
}

TEST_CASE("a recorded tape has a tick for each so many scans, and the way that was driven") {
  FleetTapeOptions options;
  options.seconds = 4.0;
  options.columns = 32;
  options.scan_hz = 2.0;
  options.resolution_m = 0.4;
  options.max_range_m = 8.0;
  const auto tape = record_fleet_tape(options);
  REQUIRE(tape.has_value());
  REQUIRE(tape->ticks.size() == 4);
  for (const FleetTape::Tick& tick : tape->ticks) CHECK(!tick.blocks.empty());
  const double driven_m =
      (tape->ticks.back().position_layer - tape->ticks.front().position_layer).norm();
  CHECK(driven_m > 0.5);
  CHECK(driven_m < 4.0);
}
