// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_cache.hpp"

namespace warren {

void MergeCache::put(MergeEntry& entry, const MergedBlock& block) {
  drop(entry);
  if (blocks_.in_use() == capacity_) evict_one();
  const std::uint32_t slot = blocks_.allocate();
  if (slot == owners_.size()) {
    owners_.push_back(nullptr);
    asked_for_.push_back(0);
  }
  blocks_[slot] = block;
  owners_[slot] = &entry;
  asked_for_[slot] = 0;
  entry.set_slot(slot);
}

void MergeCache::drop(MergeEntry& entry) {
  if (entry.has_slot()) {
    const std::uint32_t slot = entry.slot();
    owners_[slot] = nullptr;
    blocks_.release(slot);
  }
  entry.forget();
}

void MergeCache::evict_one() {
  for (;; hand_ = (hand_ + 1) % owners_.size()) {
    if (owners_[hand_] == nullptr) continue;
    if (asked_for_[hand_] == 0) return drop(*owners_[hand_]);
    asked_for_[hand_] = 0;
  }
}

std::size_t MergeCache::memory_bytes() const {
  return blocks_.memory_bytes() + owners_.capacity() * sizeof(owners_[0]) + asked_for_.capacity();
}

}  // namespace warren
