// SPDX-License-Identifier: Apache-2.0
#include "core/layer/layer_blocks.hpp"

#include <algorithm>
#include <utility>

namespace warren {

const LayerBlock* LayerBlocks::find(BlockOrdinal block) const {
  const auto found = regions_.find(region_of(block));
  if (found == regions_.end()) return nullptr;
  return blocks_of(*found)->find(RegionBlocks::place_of(block));
}

void LayerBlocks::erase(const KeyInterval& keys) {
  auto entry = regions_.lower_bound(region_of(keys.first));
  while (entry != regions_.end() && entry->first << 9 < keys.end) {
    auto& [ordinal, region] = *entry;
    const KeyInterval all = keys_of_region(ordinal);
    const bool whole = keys.first <= all.first && all.end <= keys.end;
    if (!whole) {
      wake(*entry);
      const BlockOrdinal end = std::min(all.end, keys.end);
      for (BlockOrdinal block = std::max(all.first, keys.first); block < end; ++block) {
        region.awake.erase(RegionBlocks::place_of(block));
      }
    }
    if (!whole && !region.awake.empty()) {
      ++entry;
      continue;
    }
    forget_unpacked(ordinal);
    by_change_.erase({region.changed_at, ordinal});
    awake_by_change_.erase({region.changed_at, ordinal});
    entry = regions_.erase(entry);
  }
}

std::vector<KeyInterval> LayerBlocks::regions_by_change(Revision from, std::size_t most) const {
  std::vector<KeyInterval> regions;
  for (auto latest = by_change_.rbegin(); latest != by_change_.rend(); ++latest) {
    if (latest->first <= from || regions.size() == most) break;
    regions.push_back(keys_of_region(latest->second));
  }
  return regions;
}

void LayerBlocks::drop_history(Revision until) {
  for (auto& [ordinal, region] : regions_) region.awake.drop_history(until);
}

std::vector<RegionOrdinal> LayerBlocks::rest(Revision until, std::size_t most) {
  unpacked_.clear();
  std::vector<RegionOrdinal> resting;
  while (resting.size() < most && !awake_by_change_.empty() &&
         awake_by_change_.begin()->first <= until) {
    const RegionOrdinal ordinal = awake_by_change_.begin()->second;
    awake_by_change_.erase(awake_by_change_.begin());
    Region& region = regions_.find(ordinal)->second;
    region.packed = region.awake.packed(ordinal, region.changed_at);
    region.awake = {};
    resting.push_back(ordinal);
  }
  return resting;
}

bool LayerBlocks::rests(RegionOrdinal region) const {
  const auto found = regions_.find(region);
  return found != regions_.end() && found->second.rests();
}

bool LayerBlocks::wake(RegionOrdinal region) {
  const auto found = regions_.find(region);
  return found != regions_.end() && wake(*found);
}

std::size_t LayerBlocks::memory_bytes() const {
  // A node of any tree has 32 bytes of its own.
  std::size_t bytes =
      regions_.size() * (32 + sizeof(Regions::value_type)) +
      (by_change_.size() + awake_by_change_.size()) * (32 + sizeof(ByChange::value_type));
  for (const auto& [ordinal, region] : regions_) {
    bytes += region.awake.heap_bytes() + region.packed.capacity();
  }
  for (const Unpacked& unpacked : unpacked_) {
    bytes += sizeof(RegionBlocks) + unpacked.blocks->heap_bytes();
  }
  return bytes;
}

std::size_t LayerBlocks::bytes_at_rest() const {
  std::size_t bytes = 0;
  for (const auto& [ordinal, region] : regions_) bytes += region.packed.capacity();
  return bytes;
}

bool LayerBlocks::wake(Regions::value_type& entry) {
  auto& [ordinal, region] = entry;
  if (!region.rests()) return false;
  forget_unpacked(ordinal);
  region.awake = RegionBlocks::unpacked(region.packed);
  region.packed = std::vector<std::uint8_t>();
  awake_by_change_.emplace(region.changed_at, ordinal);
  return true;
}

void LayerBlocks::mark_changed(Regions::value_type& entry, Revision revision) {
  auto& [ordinal, region] = entry;
  if (revision <= region.changed_at) return;
  for (ByChange* const order : {&by_change_, &awake_by_change_}) {
    order->erase({region.changed_at, ordinal});
    order->emplace(revision, ordinal);
  }
  region.changed_at = revision;
}

LayerBlocks::SharedBlocks LayerBlocks::blocks_of(const Regions::value_type& entry) const {
  // Owned by the region, not by this pointer.
  if (!entry.second.rests()) return {std::shared_ptr<void>(), &entry.second.awake};
  const auto found =
      std::find_if(unpacked_.begin(), unpacked_.end(),
                   [&](const Unpacked& unpacked) { return unpacked.region == entry.first; });
  if (found != unpacked_.end()) {
    std::rotate(unpacked_.begin(), found, found + 1);
  } else {
    if (unpacked_.size() == kRegionsReadMax) unpacked_.pop_back();
    auto blocks = std::make_shared<RegionBlocks>(RegionBlocks::unpacked(entry.second.packed));
    unpacked_.insert(unpacked_.begin(), {entry.first, std::move(blocks)});
  }
  return unpacked_.front().blocks;
}

void LayerBlocks::forget_unpacked(RegionOrdinal region) {
  std::erase_if(unpacked_, [&](const Unpacked& unpacked) { return unpacked.region == region; });
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
