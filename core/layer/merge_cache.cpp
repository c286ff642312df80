// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_cache.hpp"

#include <algorithm>
#include <optional>

namespace warren {
namespace {

// The one or two layers of a block; nothing if there are more.
std::optional<std::array<SourceIndex, 2>> two_sources(const MergedBlock& block) {
  const SourceIndex first = block.front().source;
  const auto other = std::find_if(block.begin(), block.end(),
                                  [&](const MergedVoxel& voxel) { return voxel.source != first; });
  const SourceIndex second = other == block.end() ? first : other->source;
  const bool no_third = std::all_of(other, block.end(), [&](const MergedVoxel& voxel) {
    return voxel.source == first || voxel.source == second;
  });
  if (!no_third) return std::nullopt;
  return std::array<SourceIndex, 2>{first, second};
}

}  // namespace

void MergeCache::put(MergeEntry& entry, const MergedBlock& block) {
  drop(entry);
  if (codes_.in_use() == capacity_) evict_one();
  const std::uint32_t slot = allocate();
  owners_[slot] = &entry;
  asked_for_[slot] = 0;
  Codes& codes = codes_[slot];
  std::transform(block.begin(), block.end(), codes.begin(),
                 [](const MergedVoxel& voxel) { return voxel.code.bits(); });
  if (const auto sources = two_sources(block)) {
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      if (block[place].source != sources->front()) codes[place] |= 128;
    }
    return entry.set_slot(slot, *sources);
  }
  sources_[slot] = std::make_unique<Sources>();
  std::transform(block.begin(), block.end(), sources_[slot]->begin(),
                 [](const MergedVoxel& voxel) { return voxel.source; });
  ++slots_with_sources_;
  entry.set_slot_of_many(slot);
}

void MergeCache::drop(MergeEntry& entry) {
  if (entry.has_slot()) {
    const std::uint32_t slot = entry.slot();
    slots_with_sources_ -= entry.has_many_sources() ? 1 : 0;
    sources_[slot].reset();
    owners_[slot] = nullptr;
    codes_.release(slot);
  }
  entry.forget();
}

std::uint32_t MergeCache::allocate() {
  const std::uint32_t slot = codes_.allocate();
  if (slot == owners_.size()) {
    owners_.push_back(nullptr);
    asked_for_.push_back(0);
    sources_.emplace_back();
  }
  return slot;
}

void MergeCache::evict_one() {
  for (;; hand_ = (hand_ + 1) % owners_.size()) {
    if (owners_[hand_] == nullptr) continue;
    if (asked_for_[hand_] == 0) return drop(*owners_[hand_]);
    asked_for_[hand_] = 0;
  }
}

std::size_t MergeCache::memory_bytes() const {
  const std::size_t pointers = owners_.capacity() + sources_.capacity();
  return codes_.memory_bytes() + slots_with_sources_ * sizeof(Sources) + asked_for_.capacity() +
         pointers * sizeof(void*);
}

}  // namespace warren
