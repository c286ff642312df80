// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/voxel/block_store.hpp"
#include "core/voxel/key.hpp"
#include "core/voxel/morton.hpp"

namespace warren {

// What the merge-map keeps of every block that a layer may reach.
struct MergeEntry {
  // Of `cached`: anything above is a slot of the cache, plus kFirstCached.
  static constexpr std::uint32_t kNotDerived = 0;
  static constexpr std::uint32_t kNothingKnown = 1;
  static constexpr std::uint32_t kFirstCached = 2;

  std::uint64_t changed_at = 0;
  std::uint32_t cached = kNotDerived;
  std::uint32_t touches = 0;  // blocks of layers that may reach it
};

// Finds entries by block key: a hash of regions, each with a dense table. Entries do not move.
class MergeIndex {
 public:
  struct Region {
    VoxelKey key{};                // voxel key / 64
    std::uint64_t changed_at = 0;  // the latest of its entries
    std::uint32_t touched = 0;     // entries with touches
    std::array<MergeEntry, kBlocksPerRegion> entries{};
  };

  // Precondition: the voxel lies in the key space. Null if its region is not there.
  MergeEntry* find(const VoxelKey& key) const {
    const std::uint32_t index = find_region(region_of(key));
    return index == kNone ? nullptr
                          : &regions_[index]->entries[morton9(key.x >> 3, key.y >> 3, key.z >> 3)];
  }

  void touch(const BlockKey& block);
  // Precondition: it was touched.
  void untouch(const BlockKey& block);
  // Precondition: the region is there.
  MergeEntry& mark_changed(const BlockKey& block, std::uint64_t number);

  // Forgets the regions that nothing touches; returns how many.
  std::size_t forget_untouched();
  std::size_t untouched_regions() const { return untouched_regions_; }

  // In Morton order.
  std::vector<Region*> regions_in_order() const;
  std::size_t memory_bytes() const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Slot {
    std::uint32_t code = kNone;  // 10 bits per axis
    std::uint32_t index = kNone;
  };

  static std::uint32_t code_of(const VoxelKey& region) {
    const auto axis = [](std::int32_t key) { return static_cast<std::uint32_t>(key + 512); };
    return axis(region.x) | axis(region.y) << 10 | axis(region.z) << 20;
  }
  // Linear probing over a table that is at most half full.
  std::uint32_t find_region(const VoxelKey& region) const {
    const std::uint32_t code = code_of(region);
    for (std::size_t at = first_slot(code);; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].code == code) return slots_[at].index;
      if (slots_[at].code == kNone) return kNone;
    }
  }
  std::size_t first_slot(std::uint32_t code) const {
    return (code * 0x9E3779B1U >> 7) & (slots_.size() - 1);
  }
  Region& region_around(const BlockKey& block);
  void insert(std::uint32_t code, std::uint32_t index);
  void rebuild(std::size_t slots);

  std::vector<Slot> slots_ = std::vector<Slot>(64);
  std::vector<std::unique_ptr<Region>> regions_;
  std::size_t untouched_regions_ = 0;
};

}  // namespace warren
