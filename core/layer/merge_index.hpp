// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/layer/voxel_code.hpp"
#include "core/voxel/block_store.hpp"
#include "core/voxel/key.hpp"
#include "core/voxel/morton.hpp"

namespace warren {

// Small number of a layer in the merge-map, 0 for none. Valid until that layer is removed.
using SourceIndex = std::uint16_t;
inline constexpr SourceIndex kNoSource = 0;

// A voxel and whose word it is.
struct MergedVoxel {
  VoxelCode code;
  SourceIndex source = kNoSource;
  friend bool operator==(const MergedVoxel&, const MergedVoxel&) = default;
};

// What the merge-map keeps of every block that a layer may reach.
class MergeEntry {
 public:
  std::uint64_t changed_at = 0;
  std::uint32_t touches = 0;  // blocks of layers that may reach it

  bool is_derived() const { return content_ != 0; }
  void forget() { content_ = 0; }

  // Most blocks are air that one layer told of: all voxels are the same, and need no memory.
  bool is_uniform() const { return (content_ & kUniform) != 0; }
  MergedVoxel uniform() const {
    const std::uint32_t bits = content_ & 127;
    const auto source = static_cast<SourceIndex>(content_ >> 7);
    const auto cost = static_cast<CostCode>(bits >> 2 & 15);
    if (bits == 0) return {};
    if (bits == VoxelCode::free().bits()) return {VoxelCode::free(), source};
    return {VoxelCode::occupied(cost, (bits & 64) != 0), source};
  }
  void set_uniform(const MergedVoxel& voxel) {
    content_ = kUniform | std::uint32_t{voxel.source} << 7 | voxel.code.bits();
  }

  bool has_slot() const { return is_derived() && !is_uniform(); }
  // In the cache. Precondition: has_slot().
  std::uint32_t slot() const { return content_ - 1; }
  void set_slot(std::uint32_t slot) { content_ = slot + 1; }

 private:
  static constexpr std::uint32_t kUniform = 0x80000000U;
  std::uint32_t content_ = 0;
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
    Region* const region = find_region(region_of(key));
    return region == nullptr ? nullptr
                             : &region->entries[morton9(key.x >> 3, key.y >> 3, key.z >> 3)];
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
  struct Slot {
    Region* region = nullptr;  // null: empty
    std::uint32_t code = 0;    // 10 bits per axis
  };

  static std::uint32_t code_of(const VoxelKey& region) {
    const auto axis = [](std::int32_t key) { return static_cast<std::uint32_t>(key + 512); };
    return axis(region.x) | axis(region.y) << 10 | axis(region.z) << 20;
  }
  // Linear probing over a table that is at most half full.
  Region* find_region(const VoxelKey& region) const {
    const std::uint32_t code = code_of(region);
    std::size_t at = first_slot(code);
    while (slots_[at].region != nullptr && slots_[at].code != code) {
      at = (at + 1) & (slots_.size() - 1);
    }
    return slots_[at].region;
  }
  std::size_t first_slot(std::uint32_t code) const {
    return (code * 0x9E3779B1U >> 7) & (slots_.size() - 1);
  }
  Region& region_around(const BlockKey& block);
  void insert(Region& region);
  void rebuild(std::size_t slots);

  std::vector<Slot> slots_ = std::vector<Slot>(64);
  std::vector<std::unique_ptr<Region>> regions_;
  std::size_t untouched_regions_ = 0;
};

}  // namespace warren
