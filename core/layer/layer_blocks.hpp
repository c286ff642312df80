// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/layer/change_history.hpp"
#include "core/layer/claim.hpp"
#include "core/layer/code_block.hpp"
#include "core/voxel/chunked_pool.hpp"

namespace warren {

// A block that was emptied stays, with no codes, because others are still to be told.
struct LayerBlock {
  CodeBlock codes;
  ChangeHistory history;
};

// All blocks of a layer in key order, found by key and by when they changed last.
class LayerBlocks {
 public:
  const LayerBlock* find(BlockOrdinal block) const;

  // Calls change(LayerBlock&) on the block, which is made if there is none; `change` records
  // something in its history.
  template <typename Change>
  void change(BlockOrdinal block, Change&& change);
  void erase(const KeyInterval& keys);

  // Calls visit(BlockOrdinal, const LayerBlock&) in key order for the blocks changed after `from`,
  // as long as it returns true. The effort does not grow with what did not change.
  template <typename Visit>
  void for_each_changed(const KeyInterval& keys, Revision from, Visit&& visit) const;

  // The regions changed after `from`, latest first, at most `most` of them.
  std::vector<KeyInterval> regions_by_change(Revision from, std::size_t most) const;

  // Gives back the memory of histories that end at or before `until`.
  void drop_history(Revision until);

  std::size_t size() const { return pool_.in_use(); }
  std::size_t memory_bytes() const;

 private:
  // Of the blocks' place in a region, one bit each that is there, and their slots in bit order.
  struct Region {
    Revision changed_at;
    std::array<std::uint64_t, 8> present{};
    std::vector<std::uint32_t> slots;

    bool has(std::uint32_t place) const { return (present[place >> 6] >> (place & 63) & 1) != 0; }
    std::size_t rank_of(std::uint32_t place) const;
  };
  using RegionOrdinal = std::uint64_t;
  using Regions = std::map<RegionOrdinal, Region>;

  static constexpr RegionOrdinal region_of(BlockOrdinal block) { return block >> 9; }
  static constexpr std::uint32_t place_of(BlockOrdinal block) {
    return static_cast<std::uint32_t>(block & 511);
  }

  LayerBlock& find_or_add(Region& region, std::uint32_t place);
  void mark_changed(Regions::value_type& entry, Revision revision);
  // In key order; as many as a packet can need, not always all.
  std::vector<const Regions::value_type*> regions_changed(const KeyInterval& keys,
                                                          Revision from) const;

  Regions regions_;
  std::set<std::pair<Revision, RegionOrdinal>> by_change_;
  ChunkedPool<LayerBlock, 64> pool_;
};

template <typename Change>
void LayerBlocks::change(BlockOrdinal block, Change&& change) {
  auto& entry = *regions_.try_emplace(region_of(block)).first;
  LayerBlock& changed = find_or_add(entry.second, place_of(block));
  change(changed);
  mark_changed(entry, changed.history.latest());
}

template <typename Visit>
void LayerBlocks::for_each_changed(const KeyInterval& keys, Revision from, Visit&& visit) const {
  KeyInterval left = keys;
  for (auto regions = regions_changed(left, from); !regions.empty();
       regions = regions_changed(left, from)) {
    for (const auto* entry : regions) {
      const auto& [ordinal, region] = *entry;
      for (std::uint32_t place = 0; place < kBlocksPerRegion; ++place) {
        const BlockOrdinal block = ordinal << 9 | place;
        if (!region.has(place) || !left.contains(block)) continue;
        const LayerBlock& found = pool_[region.slots[region.rank_of(place)]];
        if (found.history.latest() > from && !visit(block, found)) return;
      }
    }
    left.first = (regions.back()->first + 1) << 9;
    if (left.empty()) return;
  }
}

}  // namespace warren
