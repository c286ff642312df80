// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_index.hpp"

#include <algorithm>
#include <cassert>

namespace warren {
namespace {

VoxelKey region_key_of(const BlockKey& block) { return {block.x >> 3, block.y >> 3, block.z >> 3}; }

void sort_in_morton_order(std::vector<MergeIndex::Region*>& regions) {
  const auto order = [](const MergeIndex::Region* region) {
    const VoxelKey& key = region->key;
    return morton_of({key.x * kRegionEdge, key.y * kRegionEdge, key.z * kRegionEdge});
  };
  std::sort(regions.begin(), regions.end(),
            [&](const auto* a, const auto* b) { return order(a) < order(b); });
}

}  // namespace

void MergeIndex::touch(const BlockKey& block) {
  Region& region = region_around(block);
  if (region.touches[slot_in_region(block)].touches++ > 0) return;
  if (region.touched++ == 0) --untouched_regions_;
}

void MergeIndex::untouch(const BlockKey& block) {
  Region& region = region_around(block);
  MergeTouch& touch = region.touches[slot_in_region(block)];
  assert(touch.touches > 0);
  if (--touch.touches > 0) return;
  if (--region.touched == 0) ++untouched_regions_;
}

bool MergeIndex::is_touched(const BlockKey& block) const {
  const Region* const region = find_region(region_key_of(block));
  return region != nullptr && region->touches[slot_in_region(block)].touches > 0;
}

MergeEntry& MergeIndex::mark_changed(const BlockKey& block, std::uint64_t number) {
  Region& region = region_around(block);
  region.changed_at = number;
  region.touches[slot_in_region(block)].changed_at = number;
  return region.entries[slot_in_region(block)];
}

std::size_t MergeIndex::forget_untouched() {
  const std::size_t forgotten =
      std::erase_if(regions_, [](const auto& region) { return region->touched == 0; });
  untouched_regions_ = 0;
  rebuild(slots_.size());
  return forgotten;
}

std::vector<MergeIndex::Region*> MergeIndex::regions_in_order() const {
  std::vector<Region*> regions;
  regions.reserve(regions_.size());
  for (const auto& region : regions_) regions.push_back(region.get());
  sort_in_morton_order(regions);
  return regions;
}

std::vector<MergeIndex::Region*> MergeIndex::regions_changed_after(std::uint64_t number) const {
  std::vector<Region*> regions;
  for (const auto& region : regions_) {
    if (region->changed_at > number) regions.push_back(region.get());
  }
  sort_in_morton_order(regions);
  return regions;
}

std::size_t MergeIndex::memory_bytes() const {
  return slots_.capacity() * sizeof(Slot) + regions_.capacity() * sizeof(regions_[0]) +
         regions_.size() * sizeof(Region);
}

MergeIndex::Region& MergeIndex::region_around(const BlockKey& block) {
  const VoxelKey key = region_key_of(block);
  if (Region* const found = find_region(key)) return *found;
  regions_.push_back(std::make_unique<Region>());
  regions_.back()->key = key;
  ++untouched_regions_;
  if (regions_.size() * 2 > slots_.size()) {
    rebuild(slots_.size() * 2);
  } else {
    insert(*regions_.back());
  }
  return *regions_.back();
}

void MergeIndex::insert(Region& region) {
  const std::uint32_t code = code_of(region.key);
  std::size_t at = first_slot(code);
  while (slots_[at].region != nullptr) at = (at + 1) & (slots_.size() - 1);
  slots_[at] = {&region, code};
}

void MergeIndex::rebuild(std::size_t slots) {
  slots_.assign(slots, Slot{});
  for (const auto& region : regions_) insert(*region);
}

}  // namespace warren
