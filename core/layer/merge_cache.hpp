// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/layer/code_block.hpp"
#include "core/layer/merge_index.hpp"
#include "core/voxel/chunked_pool.hpp"

namespace warren {

// Places in Morton order.
using MergedBlock = std::array<MergedVoxel, kVoxelsPerBlock>;

// Derived blocks that are not uniform, at most `capacity`. A new one takes the place of one that
// nobody asked for since the hand last came by; its entry is told. A voxel takes a byte, three
// where more than two layers make a block.
class MergeCache {
 public:
  explicit MergeCache(std::size_t capacity) : capacity_(capacity == 0 ? 1 : capacity) {}

  // Precondition: the entry has a slot.
  MergedVoxel voxel(const MergeEntry& entry, std::uint32_t place) {
    const std::uint32_t slot = entry.slot();
    if (asked_for_[slot] == 0) asked_for_[slot] = 1;
    const std::uint32_t bits = codes_[slot][place];
    const SourceIndex source =
        entry.has_many_sources() ? (*sources_[slot])[place] : entry.source(bits >> 7);
    return {VoxelCode::from_bits(bits & 127), source};
  }
  // The entry must stay where it is until it is dropped.
  void put(MergeEntry& entry, const MergedBlock& block);
  void drop(MergeEntry& entry);

  std::size_t size() const { return codes_.in_use(); }
  std::size_t memory_bytes() const;

 private:
  using Codes = std::array<std::uint8_t, kVoxelsPerBlock>;
  using Sources = std::array<SourceIndex, kVoxelsPerBlock>;

  std::uint32_t allocate();
  void evict_one();

  std::size_t capacity_;
  ChunkedPool<Codes, 64> codes_;
  // By slot of the pool.
  std::vector<std::unique_ptr<Sources>> sources_;  // null where two suffice
  std::size_t slots_with_sources_ = 0;
  std::vector<MergeEntry*> owners_;
  std::vector<std::uint8_t> asked_for_;
  std::size_t hand_ = 0;
};

}  // namespace warren
