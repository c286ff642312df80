// SPDX-License-Identifier: Apache-2.0
#include "core/layer/layer_blocks.hpp"

#include <algorithm>
#include <bit>

namespace warren {

const LayerBlock* LayerBlocks::find(BlockOrdinal block) const {
  const auto found = regions_.find(region_of(block));
  if (found == regions_.end() || !found->second.has(place_of(block))) return nullptr;
  return &pool_[found->second.slots[found->second.rank_of(place_of(block))]];
}

void LayerBlocks::erase(const KeyInterval& keys) {
  auto entry = regions_.lower_bound(region_of(keys.first));
  while (entry != regions_.end() && entry->first << 9 < keys.end) {
    auto& [ordinal, region] = *entry;
    for (std::uint32_t place = 0; place < kBlocksPerRegion; ++place) {
      if (!region.has(place) || !keys.contains(ordinal << 9 | place)) continue;
      const auto slot = region.slots.begin() + static_cast<std::ptrdiff_t>(region.rank_of(place));
      pool_[*slot] = {};
      pool_.release(*slot);
      region.slots.erase(slot);
      region.present[place >> 6] &= ~(std::uint64_t{1} << (place & 63));
    }
    if (!region.slots.empty()) {
      ++entry;
      continue;
    }
    by_change_.erase({region.changed_at, ordinal});
    entry = regions_.erase(entry);
  }
}

std::vector<KeyInterval> LayerBlocks::regions_by_change(Revision from, std::size_t most) const {
  std::vector<KeyInterval> regions;
  for (auto latest = by_change_.rbegin(); latest != by_change_.rend(); ++latest) {
    const auto& [changed_at, ordinal] = *latest;
    if (changed_at <= from || regions.size() == most) break;
    regions.push_back({ordinal << 9, (ordinal + 1) << 9});
  }
  return regions;
}

void LayerBlocks::drop_history(Revision until) {
  for (auto& [ordinal, region] : regions_) {
    for (const std::uint32_t slot : region.slots) {
      ChangeHistory& history = pool_[slot].history;
      if (history.latest() <= until) history.drop();
    }
  }
}

std::size_t LayerBlocks::memory_bytes() const {
  // A node of either tree has 32 bytes of its own.
  std::size_t bytes = pool_.memory_bytes() + regions_.size() * (32 + sizeof(Regions::value_type)) +
                      by_change_.size() * (32 + sizeof(*by_change_.begin()));
  for (const auto& [ordinal, region] : regions_) {
    bytes += region.slots.capacity() * sizeof(region.slots[0]);
    for (const std::uint32_t slot : region.slots) {
      bytes += pool_[slot].codes.heap_bytes() + pool_[slot].history.heap_bytes();
    }
  }
  return bytes;
}

std::size_t LayerBlocks::Region::rank_of(std::uint32_t place) const {
  const std::size_t word = place >> 6;
  int rank = std::popcount(present[word] & ((std::uint64_t{1} << (place & 63)) - 1));
  for (std::size_t before = 0; before < word; ++before) rank += std::popcount(present[before]);
  return static_cast<std::size_t>(rank);
}

LayerBlock& LayerBlocks::find_or_add(Region& region, std::uint32_t place) {
  const std::size_t rank = region.rank_of(place);
  if (!region.has(place)) {
    region.slots.insert(region.slots.begin() + static_cast<std::ptrdiff_t>(rank), pool_.allocate());
    region.present[place >> 6] |= std::uint64_t{1} << (place & 63);
  }
  return pool_[region.slots[rank]];
}

void LayerBlocks::mark_changed(Regions::value_type& entry, Revision revision) {
  auto& [ordinal, region] = entry;
  if (revision <= region.changed_at) return;
  by_change_.erase({region.changed_at, ordinal});
  by_change_.emplace(revision, ordinal);
  region.changed_at = revision;
}

std::vector<const LayerBlocks::Regions::value_type*> LayerBlocks::regions_changed(
    const KeyInterval& keys, Revision from) const {
  // Few changes are found from the latest back; among many, the next in key order are near.
  constexpr std::size_t kFew = 256;
  std::vector<const Regions::value_type*> changed;
  auto latest = by_change_.rbegin();
  std::size_t looked_at = 0;
  for (; latest != by_change_.rend() && latest->first > from && looked_at < kFew; ++latest) {
    ++looked_at;
    const RegionOrdinal ordinal = latest->second;
    if (region_of(keys.first) <= ordinal && ordinal << 9 < keys.end) {
      changed.push_back(&*regions_.find(ordinal));
    }
  }
  if (looked_at < kFew) {
    std::sort(changed.begin(), changed.end(),
              [](const auto* a, const auto* b) { return a->first < b->first; });
    return changed;
  }
  changed.clear();
  for (auto entry = regions_.lower_bound(region_of(keys.first));
       entry != regions_.end() && entry->first << 9 < keys.end && changed.size() < kFew; ++entry) {
    if (entry->second.changed_at > from) changed.push_back(&*entry);
  }
  return changed;
}

}  // namespace warren
