// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

#include "core/voxel/key.hpp"
#include "core/voxel/morton.hpp"

namespace warren {

// A layer: `number` counts the layers of its origin, the incarnation is drawn at random when it is
// created, so that a node that lost its disk is never taken for its former self.
struct LayerId {
  std::uint32_t origin = 0;
  std::uint32_t number = 0;
  std::uint64_t incarnation = 0;
  friend auto operator<=>(const LayerId&, const LayerId&) = default;
};

// Number of a publishing tick of a layer; 0 is the empty layer before the first.
struct Revision {
  std::uint32_t number = 0;
  friend auto operator<=>(const Revision&, const Revision&) = default;
};

// Position of a block in the order of all blocks: the Morton code of its key. Regions of 8x8x8
// blocks lie in Morton order, and the blocks of one region together.
using BlockOrdinal = std::uint64_t;
inline constexpr BlockOrdinal kOrdinalEnd = BlockOrdinal{1} << 39;

constexpr BlockOrdinal ordinal_of(const BlockKey& key) {
  return morton_of(first_voxel_of(key)) >> 9;
}
constexpr BlockKey block_key_of(BlockOrdinal ordinal) {
  return block_of(key_of_morton(ordinal << 9));
}

// A region is 8x8x8 blocks: the ordinal of the first of them without its low nine bits.
using RegionOrdinal = std::uint64_t;
constexpr RegionOrdinal region_of(BlockOrdinal block) { return block >> 9; }

// The blocks from `first` up to, not including, `end`.
struct KeyInterval {
  BlockOrdinal first = 0;
  BlockOrdinal end = kOrdinalEnd;

  constexpr bool empty() const { return first >= end; }
  constexpr bool contains(BlockOrdinal ordinal) const { return first <= ordinal && ordinal < end; }
  friend bool operator==(const KeyInterval&, const KeyInterval&) = default;
};

constexpr KeyInterval keys_of_region(RegionOrdinal region) {
  return {region << 9, (region + 1) << 9};
}

// What a diff packet says of itself: it holds whatever changed in these blocks after `from`, up to
// and including `to`, as of `to`. Invariant of a valid claim: keys not empty and within
// kOrdinalEnd, from < to.
struct Claim {
  KeyInterval keys;
  Revision from;
  Revision to;

  constexpr bool valid() const { return !keys.empty() && keys.end <= kOrdinalEnd && from < to; }
  friend bool operator==(const Claim&, const Claim&) = default;
};

}  // namespace warren
