// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/voxel/block_store.hpp"
#include "core/voxel/ray_path.hpp"

namespace warren {

using BlockMask = std::array<std::uint64_t, kCellsPerBlock>;

// A block that the scan touched.
struct MarkedBlock {
  // Voxels that need no more work in this scan: at the free clamp before it (another pass changes
  // nothing), passed, or hit.
  BlockMask done{};
  std::uint32_t region = 0;
  std::uint32_t slot = 0;
  std::uint32_t hits = kNoHits;  // index among the hit masks

  static constexpr std::uint32_t kNoHits = 0xFFFFFFFFU;
};

// First step of an integration: which voxels a scan hits and which it passes, without touching any
// value. Mark all hits first: a hit then wins over a pass because it is done already.
class ScanMarker {
 public:
  // Starts a scan over this store, which must outlive it. Regions are added to it as they are met.
  void begin(BlockStore& store);
  void hit(const VoxelKey& key);
  // All that remains of the walker's way; `path` made it.
  void pass(RayPath& path, RayWalker walker);

  std::uint32_t marked_count() const { return marked_.in_use(); }
  const MarkedBlock& marked(std::uint32_t index) const { return marked_[index]; }
  // The block's hits; all zero if it has none.
  const BlockMask& hits(const MarkedBlock& block) const {
    return block.hits == MarkedBlock::kNoHits ? kNothing : hits_[block.hits];
  }
  std::size_t memory_bytes() const;

 private:
  // What this scan knows of a block: 0 not met yet; bit 31 every voxel done; below it the number of
  // its MarkedBlock + 1, or 0 if it has none.
  using Entry = std::uint32_t;
  static constexpr Entry kAllDone = 0x80000000U;
  static constexpr BlockMask kNothing{};
  static constexpr std::uint64_t kNoRegion = ~std::uint64_t{0};

  struct ScanRegion {
    std::uint32_t index = 0;
    std::array<Entry, kBlocksPerRegion> entries{};
  };

  struct CachedRegion {
    std::uint64_t code = kNoRegion;
    ScanRegion* region = nullptr;
  };

  // By Morton code of a voxel.
  Entry& enter_block(std::uint64_t code);
  void enter_region(std::uint64_t region_code);
  ScanRegion& find_region(std::uint64_t region_code);
  Entry first_entry(std::uint32_t region, std::uint32_t slot);
  Entry add_marked(std::uint32_t region, std::uint32_t slot);
  void mark_voxels(std::uint64_t code, std::span<const std::uint64_t> steps);

  BlockStore* store_ = nullptr;
  std::vector<std::unique_ptr<ScanRegion>> regions_;
  std::vector<std::uint32_t> region_numbers_;  // store's region index -> number in regions_ + 1
  std::uint32_t regions_used_ = 0;
  ScanRegion* current_ = nullptr;
  std::uint64_t current_code_ = kNoRegion;  // Morton code of the current region
  // Regions met lately, by the low bits of their Morton codes: rays come back to the same few.
  std::array<CachedRegion, 64> cache_{};
  ChunkedPool<MarkedBlock, 128> marked_;
  ChunkedPool<BlockMask, 128> hits_;
};

}  // namespace warren
