// SPDX-License-Identifier: Apache-2.0
#include "core/layer/change_history.hpp"

#include <array>

#include <doctest/doctest.h>

#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

using LastChanges = std::array<std::uint32_t, kVoxelsPerBlock>;

std::uint32_t voxels_in(const VoxelMask& mask) {
  std::uint32_t count = 0;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) count += contains(mask, place);
  return count;
}

void check_contains(const ChangeHistory& history, const LastChanges& changes, std::uint32_t now) {
  for (std::uint32_t from = 0; from <= now; ++from) {
    const VoxelMask mask = history.changed_since({from});
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      REQUIRE((changes[place] <= from || contains(mask, place)));
    }
  }
}

}  // namespace

TEST_CASE("no change is ever missed, however groups merge and are dropped") {
  test::Random random(1);
  for (int round = 0; round < 20; ++round) {
    ChangeHistory history;
    LastChanges changes{};
    for (std::uint32_t revision = 1; revision < 25; ++revision) {
      if (test::chance(random, 5)) history.drop();
      if (test::chance(random, 30)) continue;
      const VoxelMask mask = test::random_mask(random);
      for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
        if (contains(mask, place)) changes[place] = revision;
      }
      history.record({revision}, mask);
      CHECK(history.latest() == Revision{revision});
    }
    check_contains(history, changes, 25);
  }
}

TEST_CASE("the latest changes are remembered exactly, what never changed is not sent") {
  ChangeHistory history;
  VoxelMask changed{};
  for (std::uint32_t revision = 1; revision <= 40; ++revision) {
    VoxelMask mask{};
    insert(mask, revision);
    insert(changed, revision);
    history.record({revision}, mask);
  }
  for (std::uint32_t back = 1; back < ChangeHistory::kGroups - 1; ++back) {
    CHECK(voxels_in(history.changed_since({40 - back})) == back);
  }
  CHECK(history.changed_since({0}) == changed);
  CHECK_FALSE(any(history.changed_since({40})));
}

TEST_CASE("without its groups a block has changed as a whole") {
  ChangeHistory history;
  VoxelMask mask{};
  insert(mask, 7);
  history.record({3}, mask);
  CHECK(history.heap_bytes() > 0);
  history.drop();
  CHECK(history.heap_bytes() == 0);
  CHECK(voxels_in(history.changed_since({2})) == kVoxelsPerBlock);
  CHECK(voxels_in(history.changed_since({3})) == 0);
  history.record({5}, mask);
  CHECK(voxels_in(history.changed_since({3})) == 1);
  history.record_all({6});
  CHECK(voxels_in(history.changed_since({5})) == kVoxelsPerBlock);
}
