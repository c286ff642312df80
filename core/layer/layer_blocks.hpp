// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/layer/claim.hpp"
#include "core/layer/region_blocks.hpp"

namespace warren {

// All blocks of a layer in key order, found by key and by when they changed last. Regions that no
// one changes can be laid to rest: packed, at a thirtieth of the memory. Reading one unpacks it
// into a small cache, changing one wakes it for good. Because of the cache one thread at a time may
// use this, even to read.
class LayerBlocks {
 public:
  static constexpr std::size_t kRegionsReadMax = 8;  // of those at rest, kept unpacked

  // Null if there is none. Valid until the next call of any function here.
  const LayerBlock* find(BlockOrdinal block) const;

  // Calls change(LayerBlock&) on the block, which is made if there is none; `change` records
  // something in its history.
  template <typename Change>
  void change(BlockOrdinal block, Change&& change);
  void erase(const KeyInterval& keys);

  // Calls visit(BlockOrdinal, const LayerBlock&) in key order for the blocks changed after `from`,
  // as long as it returns true. The effort does not grow with what did not change. The block is
  // valid during the visit, whatever else that reads.
  template <typename Visit>
  void for_each_changed(const KeyInterval& keys, Revision from, Visit&& visit) const;

  // The regions changed after `from`, latest first, at most `most` of them.
  std::vector<KeyInterval> regions_by_change(Revision from, std::size_t most) const;

  // Gives back the memory of histories that end at or before `until`.
  void drop_history(Revision until);

  // Lays the longest unchanged regions to rest, at most `most` of them, of those unchanged since
  // `until`; which ones. Empties the cache.
  std::vector<RegionOrdinal> rest(Revision until, std::size_t most);
  bool rests(RegionOrdinal region) const;
  // False if it was awake.
  bool wake(RegionOrdinal region);

  std::size_t regions() const { return by_change_.size(); }
  std::size_t regions_awake() const { return awake_by_change_.size(); }
  std::size_t memory_bytes() const;
  // Of these, what the regions at rest take.
  std::size_t bytes_at_rest() const;

 private:
  struct Region {
    Revision changed_at;
    RegionBlocks awake;
    std::vector<std::uint8_t> packed;  // empty while it is awake

    bool rests() const { return !packed.empty(); }
  };
  using Regions = std::map<RegionOrdinal, Region>;
  using ByChange = std::set<std::pair<Revision, RegionOrdinal>>;
  using SharedBlocks = std::shared_ptr<const RegionBlocks>;

  struct Unpacked {
    RegionOrdinal region = 0;
    SharedBlocks blocks;
  };

  bool wake(Regions::value_type& entry);
  void mark_changed(Regions::value_type& entry, Revision revision);
  // Of one at rest a copy, kept alive by the holder alone.
  SharedBlocks blocks_of(const Regions::value_type& entry) const;
  void forget_unpacked(RegionOrdinal region);
  // In key order; as many as a packet can need, not always all.
  std::vector<const Regions::value_type*> regions_changed(const KeyInterval& keys,
                                                          Revision from) const;

  Regions regions_;
  ByChange by_change_;
  ByChange awake_by_change_;
  mutable std::vector<Unpacked> unpacked_;  // last read first
};

template <typename Change>
void LayerBlocks::change(BlockOrdinal block, Change&& change) {
  auto& entry = *regions_.try_emplace(region_of(block)).first;
  wake(entry);
  LayerBlock& changed = entry.second.awake.find_or_add(RegionBlocks::place_of(block));
  change(changed);
  mark_changed(entry, changed.history.latest());
}

template <typename Visit>
void LayerBlocks::for_each_changed(const KeyInterval& keys, Revision from, Visit&& visit) const {
  KeyInterval left = keys;
  for (auto regions = regions_changed(left, from); !regions.empty();
       regions = regions_changed(left, from)) {
    for (const auto* entry : regions) {
      const BlockOrdinal first = entry->first << 9;
      const bool goes_on =
          blocks_of(*entry)->for_each([&](std::uint32_t place, const LayerBlock& block) {
            if (!left.contains(first | place) || block.history.latest() <= from) return true;
            return static_cast<bool>(visit(first | place, block));
          });
      if (!goes_on) return;
    }
    left.first = (regions.back()->first + 1) << 9;
    if (left.empty()) return;
  }
}

}  // namespace warren
