// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/layer/code_block.hpp"
#include "core/layer/merge_index.hpp"
#include "core/voxel/chunked_pool.hpp"

namespace warren {

// Places in Morton order.
using MergedBlock = std::array<MergedVoxel, kVoxelsPerBlock>;

// Derived blocks, at most `capacity`. A new one takes the place of one that nobody asked for since
// the hand last came by; its entry is told.
class MergeCache {
 public:
  explicit MergeCache(std::size_t capacity) : capacity_(capacity == 0 ? 1 : capacity) {}

  const MergedBlock& get(const MergeEntry& entry) {
    const std::uint32_t slot = entry.slot();
    if (asked_for_[slot] == 0) asked_for_[slot] = 1;
    return blocks_[slot];
  }
  // The entry must stay where it is until it is dropped.
  void put(MergeEntry& entry, const MergedBlock& block);
  void drop(MergeEntry& entry);

  std::size_t size() const { return blocks_.in_use(); }
  std::size_t memory_bytes() const;

 private:
  void evict_one();

  std::size_t capacity_;
  ChunkedPool<MergedBlock, 64> blocks_;
  // By slot of the pool.
  std::vector<MergeEntry*> owners_;
  std::vector<std::uint8_t> asked_for_;
  std::size_t hand_ = 0;
};

}  // namespace warren
