// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/layer/publisher.hpp"
#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

constexpr BlockOrdinal kBlock = 5;
constexpr SenderRules kFreeOnly{true, false};
constexpr SenderRules kCostsOnly{false, true};
constexpr SenderRules kNoRules{false, false};

// An origin that publishes one block.
struct Origin {
  explicit Origin(const SenderRules& rules) : publisher(rules) {}

  VoxelCode shown(std::uint32_t place) const {
    const LayerBlock* const block = layer.find(kBlock);
    return block != nullptr ? block->codes.at(place) : VoxelCode{};
  }
  void tick() {
    const std::vector<CodedBlock> now = {{kBlock, CodeBlock(exact)}};
    layer.publish(publisher.tick(now, layer));
  }
  void set_and_tick(std::uint32_t place, VoxelCode code) {
    exact.set(place, code);
    tick();
  }
  void flush() { layer.publish(publisher.flush(layer)); }

  BlockCodes exact;
  Replica layer{LayerId{1, 1, 1}, kDefaultResolution};
  Publisher publisher;
};

VoxelCode cost(CostCode code, bool stair = false) { return VoxelCode::occupied(code, stair); }

// What a planner may ever meet in place of the exact code.
bool is_right(VoxelCode shown, VoxelCode exact, const SenderRules& rules) {
  if (shown == exact) return true;
  if (exact.state() == VoxelState::kFree) {
    return rules.hold_ragged_free && shown.state() == VoxelState::kUnknown;
  }
  const bool one_bin_off = std::abs(int{shown.cost()} - int{exact.cost()}) == 1;
  return rules.hold_small_cost_changes && shown.state() == exact.state() && one_bin_off &&
         shown.stair() == exact.stair() && shown.cost() != kNoCostData &&
         exact.cost() != kNoCostData &&
         is_safe(shown.cost(), 0.1F) == is_safe(exact.cost(), 0.1F) &&
         is_safe(shown.cost(), 0.2F) == is_safe(exact.cost(), 0.2F);
}

// Most voxels change a little, as they do under a robot.
VoxelCode next_code(test::Random& random, VoxelCode before) {
  if (before.state() != VoxelState::kOccupied || test::chance(random, 30)) {
    return test::random_code(random);
  }
  const auto near = static_cast<CostCode>(before.cost() + test::below(random, 3));
  return cost(static_cast<CostCode>(near == 0 ? 0 : std::min(near - 1, 15)), before.stair());
}

}  // namespace

TEST_CASE("a new free voxel waits until its cube is known, and then the whole cube goes") {
  Origin origin(kFreeOnly);
  for (std::uint32_t place = 8; place < 15; ++place) {
    origin.set_and_tick(place, VoxelCode::free());
    CHECK(origin.shown(place) == VoxelCode{});
  }
  CHECK(origin.publisher.blocks_held_back() == 1);
  origin.set_and_tick(15, cost(3));
  for (std::uint32_t place = 8; place < 15; ++place)
    CHECK(origin.shown(place) == VoxelCode::free());
  CHECK(origin.shown(15) == cost(3));
  CHECK(origin.publisher.blocks_held_back() == 0);
}

TEST_CASE("neither an occupied voxel waits nor one that is free again") {
  Origin origin(SenderRules{});
  origin.set_and_tick(100, cost(3));
  CHECK(origin.shown(100) == cost(3));
  origin.set_and_tick(100, VoxelCode::free());
  CHECK(origin.shown(100) == VoxelCode::free());
  origin.set_and_tick(100, {});
  CHECK(origin.shown(100) == VoxelCode{});
  CHECK(origin.publisher.blocks_held_back() == 0);
}

TEST_CASE("a cost waits while it is one bin off, and no longer") {
  Origin origin(kCostsOnly);
  origin.set_and_tick(7, cost(9));
  origin.set_and_tick(7, cost(10));
  CHECK(origin.shown(7) == cost(9));
  CHECK(origin.publisher.blocks_held_back() == 1);
  origin.set_and_tick(7, cost(8));
  CHECK(origin.shown(7) == cost(9));
  origin.set_and_tick(7, cost(11));
  CHECK(origin.shown(7) == cost(11));
  CHECK(origin.publisher.blocks_held_back() == 0);
}

TEST_CASE("a cost that crosses a threshold of the planner does not wait") {
  for (CostCode lower = 1; lower < 15; ++lower) {
    // Bins 2 and 4 end at 0.10 and 0.20.
    const bool crosses = lower == 2 || lower == 4;
    for (const bool rises : {true, false}) {
      const auto upper = static_cast<CostCode>(lower + 1);
      Origin origin(SenderRules{});
      origin.set_and_tick(7, cost(rises ? lower : upper));
      origin.set_and_tick(7, cost(rises ? upper : lower));
      CHECK((origin.shown(7).cost() == (rises ? upper : lower)) == crosses);
    }
  }
}

TEST_CASE("neither data that begins or ends nor a stair waits") {
  Origin origin(SenderRules{});
  for (const VoxelCode code : {cost(0), cost(1), cost(0), cost(1), cost(1, true), cost(2, true),
                               cost(2), cost(2, true), cost(1, false)}) {
    const bool only_cost =
        origin.shown(7).cost() != 0 && code.cost() != 0 && origin.shown(7).stair() == code.stair();
    const VoxelCode before = origin.shown(7);
    origin.set_and_tick(7, code);
    CHECK(origin.shown(7) == (only_cost ? before : code));
  }
}

TEST_CASE("without rules nothing waits") {
  test::Random random(1);
  Origin origin(kNoRules);
  for (int round = 0; round < 20; ++round) {
    origin.exact = test::random_codes(random, 50);
    origin.tick();
    CHECK(origin.layer.find(kBlock)->codes == CodeBlock(origin.exact));
    CHECK(origin.publisher.blocks_held_back() == 0);
  }
}

TEST_CASE("a block that is not handed in again goes on waiting, and a flush sends it") {
  Origin origin(SenderRules{});
  origin.set_and_tick(0, VoxelCode::free());
  const std::vector<CodedBlock> other = {{kBlock + 1, CodeBlock(origin.exact)}};
  origin.layer.publish(origin.publisher.tick(other, origin.layer));
  CHECK(origin.publisher.blocks_held_back() == 2);
  origin.flush();
  CHECK(origin.publisher.blocks_held_back() == 0);
  CHECK(origin.shown(0) == VoxelCode::free());
  CHECK(origin.layer.find(kBlock + 1)->codes == CodeBlock(origin.exact));
  CHECK(origin.publisher.flush(origin.layer).empty());
}

TEST_CASE("whatever comes, no published voxel is ever wrong, and after a flush all are exact") {
  CHECK(rc::check("never wrong", [](std::uint64_t seed) {
    test::Random random(seed);
    const SenderRules rules{test::chance(random, 70), test::chance(random, 70)};
    Origin origin(rules);
    for (std::uint32_t ticks = 1 + test::below(random, 12); ticks > 0; --ticks) {
      for (std::uint32_t count = test::below(random, 300); count > 0; --count) {
        const std::uint32_t place = test::below(random, kVoxelsPerBlock);
        origin.exact.set(place, next_code(random, origin.exact.at(place)));
      }
      origin.tick();
      bool differs = false;
      for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
        RC_ASSERT(is_right(origin.shown(place), origin.exact.at(place), rules));
        differs |= origin.shown(place) != origin.exact.at(place);
      }
      RC_ASSERT(origin.publisher.blocks_held_back() == (differs ? 1U : 0U));
      if (!test::chance(random, 10)) continue;
      origin.flush();
      RC_ASSERT(origin.layer.codes_in_place(kBlock) == CodeBlock(origin.exact));
    }
    origin.flush();
    RC_ASSERT(origin.publisher.blocks_held_back() == 0);
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      RC_ASSERT(origin.shown(place) == origin.exact.at(place));
    }
  }));
}
