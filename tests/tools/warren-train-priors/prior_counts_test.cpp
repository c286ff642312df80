// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-train-priors/prior_counts.hpp"

#include <cstdlib>

#include <doctest/doctest.h>

#include "core/layer/diff_packet.hpp"
#include "tools/warren-train-priors/first_guess.hpp"
#include "tools/warren-train-priors/tick_recording.hpp"

using namespace warren;

namespace {

CodedBlock floor_block(BlockOrdinal block) {
  BlockCodes codes;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const std::int32_t z = place_of_morton9(place).z;
    if (z == 3) codes.set(place, VoxelCode::occupied(9, true));
    if (z > 3) codes.set(place, VoxelCode::free());
  }
  return {block, CodeBlock(codes)};
}

int byte_at(const PriorCounts& counts, std::size_t context) { return counts.table()[context]; }

}  // namespace

TEST_CASE("where nothing was counted the table is the first guess") {
  const auto table = PriorCounts().table();
  const DiffPriors guess = first_guess();
  REQUIRE(table.size() == guess.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    CHECK(std::abs(int{table[i]} - int{guess[i] >> 8}) <= 1);
  }
}

TEST_CASE("what packets say often is expected of the next one") {
  PriorCounts counts;
  const PriorCounts none;
  const Ticks ticks = {{floor_block(8), floor_block(9)}};
  for (int i = 0; i < 50; ++i) {
    send_ticks(ticks, {}, false, [&](const auto& packet) { counts.add(packet); });
  }
  CHECK(counts.packets() == 50);
  CHECK(byte_at(counts, diff_context::kStair + 2) > byte_at(none, diff_context::kStair + 2));
  CHECK(byte_at(counts, diff_context::kStair + 2) > 240);
  CHECK(byte_at(counts, diff_context::kNoData) < byte_at(none, diff_context::kNoData));
}

TEST_CASE("merged ticks hold the latest codes of each block once") {
  const CodedBlock first = floor_block(8);
  const CodedBlock emptied{8, {}};
  const Ticks merged = merge_ticks({{first}, {emptied, floor_block(9)}, {first}}, 2);
  REQUIRE(merged.size() == 2);
  REQUIRE(merged[0].size() == 2);
  CHECK(merged[0][0].codes.empty());
  CHECK(merged[0][1].block == 9);
  CHECK(merged[1][0].codes == first.codes);
}
