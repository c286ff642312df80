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

// What a query needs of a block apart from its codes, in few bytes: this is what random points miss
// the processor's cache for.
class MergeEntry {
 public:
  MergeEntry() = default;

  bool is_derived() const { return kind_ != Kind::kNone; }
  void forget() { *this = {}; }

  // Most blocks are air that one layer told of: all voxels are the same, and need no memory.
  bool is_uniform() const { return kind_ == Kind::kUniform; }
  MergedVoxel uniform() const { return {VoxelCode::from_bits(content_ & 127), sources_[0]}; }
  void set_uniform(const MergedVoxel& voxel) {
    *this = {Kind::kUniform, voxel.code.bits(), {voxel.source, kNoSource}};
  }

  // The slot in the cache whose codes are the block's; the eighth bit of each tells which of these
  // two layers it comes from.
  bool has_slot() const { return kind_ == Kind::kTwoSources || kind_ == Kind::kManySources; }
  std::uint32_t slot() const { return content_; }
  SourceIndex source(std::uint32_t which) const { return sources_[which]; }
  void set_slot(std::uint32_t slot, const std::array<SourceIndex, 2>& sources) {
    *this = {Kind::kTwoSources, slot, sources};
  }
  // More than two layers: the cache knows which, voxel by voxel.
  bool has_many_sources() const { return kind_ == Kind::kManySources; }
  void set_slot_of_many(std::uint32_t slot) { *this = {Kind::kManySources, slot, {}}; }

 private:
  enum class Kind : std::uint32_t { kNone, kUniform, kTwoSources, kManySources };
  MergeEntry(Kind kind, std::uint32_t content, const std::array<SourceIndex, 2>& sources)
      : kind_(kind), content_(content & kContentMax), sources_(sources) {}

  static constexpr std::uint32_t kContentMax = 0x3FFFFFFF;  // more than a cache can hold
  Kind kind_ : 2 = Kind::kNone;
  std::uint32_t content_ : 30 = 0;
  std::array<SourceIndex, 2> sources_{};
};
static_assert(sizeof(MergeEntry) == 8);

// Kept of every block that a layer may reach.
struct MergeTouch {
  std::uint64_t changed_at = 0;
  std::uint32_t touches = 0;  // blocks of layers that may reach it
};

// Finds entries by block key: a hash of regions, each with a dense table. Entries do not move.
class MergeIndex {
 public:
  struct Region {
    VoxelKey key{};                // voxel key / 64
    std::uint64_t changed_at = 0;  // the latest of its entries
    std::uint32_t touched = 0;     // blocks with touches
    std::array<MergeEntry, kBlocksPerRegion> entries{};
    std::array<MergeTouch, kBlocksPerRegion> touches{};
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
  bool is_touched(const BlockKey& block) const;
  // Precondition: the region is there.
  MergeEntry& mark_changed(const BlockKey& block, std::uint64_t number);

  // Forgets the regions that nothing touches; returns how many.
  std::size_t forget_untouched();
  std::size_t untouched_regions() const { return untouched_regions_; }

  // In Morton order: all, or those that changed after the change of this number.
  std::vector<Region*> regions_in_order() const;
  std::vector<Region*> regions_changed_after(std::uint64_t number) const;
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
