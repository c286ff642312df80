// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/voxel/chunked_pool.hpp"
#include "core/voxel/key.hpp"
#include "core/voxel/morton.hpp"
#include "core/voxel/packed_cells.hpp"
#include "core/voxel/voxel_cost.hpp"

namespace warren {

struct BlockState;

enum class VoxelState : std::uint8_t { kUnknown, kFree, kOccupied };

inline constexpr std::size_t kCellsPerBlock = 8;      // of 4x4x4 voxels
inline constexpr std::size_t kBlocksPerRegion = 512;  // of 8x8x8 voxels
inline constexpr std::uint64_t kFullCell = ~std::uint64_t{0};

using LogOddsCells = PackedCells<std::int16_t>;
using CostCells = PackedCells<FusedCost>;

// One bit per voxel and property, cells and bits in Morton order. Invariant: occupied and
// clamped_free are disjoint parts of known; a voxel has a stored value exactly if it is known and
// not clamped_free.
struct Block {
  std::array<std::uint64_t, kCellsPerBlock> known{};
  std::array<std::uint64_t, kCellsPerBlock> occupied{};
  std::array<std::uint64_t, kCellsPerBlock> clamped_free{};
  std::array<LogOddsCells::Ref, kCellsPerBlock> values{};
  std::uint32_t costs = 0;  // index of its BlockCosts + 1; 0 if it has none

  std::uint64_t stored(std::size_t cell) const { return known[cell] & ~clamped_free[cell]; }
};

// The costs of a block's ground: most blocks are air and have none. Invariant: `costed` is part of
// the voxels with a stored value, and not empty.
struct BlockCosts {
  std::array<std::uint64_t, kCellsPerBlock> costed{};
  std::array<CostCells::Ref, kCellsPerBlock> values{};
};

// What a region knows of one of its blocks.
using BlockSlot = std::uint32_t;
inline constexpr BlockSlot kAbsentBlock = 0;     // nothing known
inline constexpr BlockSlot kFreeBlock = 1;       // every voxel at the free clamp: needs no Block
inline constexpr BlockSlot kFirstBlockSlot = 2;  // from here on: index of the Block + 2

// 8x8x8 blocks, in Morton order.
struct Region {
  VoxelKey key{};  // voxel key / 64
  std::array<BlockSlot, kBlocksPerRegion> slots{};
  std::array<std::uint32_t, kBlocksPerRegion> changed_at{};  // number of a scan; 0 never
};

constexpr VoxelKey region_of(const VoxelKey& key) { return {key.x >> 6, key.y >> 6, key.z >> 6}; }
constexpr std::uint32_t slot_in_region(const BlockKey& key) { return morton9(key.x, key.y, key.z); }
constexpr BlockKey block_in_region(const VoxelKey& region, std::uint32_t slot) {
  const VoxelKey place = place_of_morton9(slot);
  return {region.x * 8 + place.x, region.y * 8 + place.y, region.z * 8 + place.z};
}

// All blocks of a layer: a hash of regions, each with a dense table of its blocks.
class BlockStore {
 public:
  static constexpr std::uint32_t kNoRegion = 0xFFFFFFFFU;

  // Index of the region, or kNoRegion.
  std::uint32_t find_region(const VoxelKey& region) const;
  std::uint32_t find_or_add_region(const VoxelKey& region);
  std::uint32_t region_count() const { return static_cast<std::uint32_t>(regions_.size()); }
  Region& region(std::uint32_t index) { return *regions_[index]; }
  const Region& region(std::uint32_t index) const { return *regions_[index]; }
  // The block in this slot of the region changed at the scan, the latest so far.
  void mark_changed(std::uint32_t index, std::uint32_t slot, std::uint32_t scan) {
    regions_[index]->changed_at[slot] = scan;
    last_changes_[index] = scan;
  }
  // By region index the latest of its blocks' changes: what a look at every region may cost.
  std::span<const std::uint32_t> last_changes() const { return last_changes_; }
  // Region indices by Morton order of their keys.
  std::vector<std::uint32_t> regions_in_order() const;

  BlockSlot slot_of(const BlockKey& key) const;
  VoxelState state(const VoxelKey& key) const;
  // Fixed-point log-odds; nothing when unknown. `minimum` is the free clamp.
  std::optional<std::int16_t> value(const VoxelKey& key, std::int16_t minimum) const;

  // The block behind a slot; absent and free ones get one.
  Block& materialise(BlockSlot& slot);
  // Gives back the block's memory if every voxel is at the free clamp.
  void collapse_if_free(BlockSlot& slot);

  Block& block(BlockSlot slot) { return pool_[slot - kFirstBlockSlot]; }
  const Block& block(BlockSlot slot) const { return pool_[slot - kFirstBlockSlot]; }
  // Gives one voxel of the block its first cost, or another.
  void set_cost(Block& block, std::uint32_t place, const FusedCost& cost);
  // The fused cost of the voxel at this place in the block (Morton code), whatever its state;
  // nothing when it has none.
  std::optional<FusedCost> cost(const Block& block, std::uint32_t place) const;
  // Writes those of a cell to their places; returns which they are.
  std::uint64_t unpack_costs(const Block& block, std::size_t cell,
                             std::array<FusedCost, 64>& costs) const;
  // Voxels at the free clamp keep no cost: what stood there has gone.
  void forget_costs_at_clamp(Block& block);

  // All that is known of the block, to be imported elsewhere; nothing if nothing is.
  std::optional<BlockState> export_block(const BlockKey& key) const;
  // Preconditions: the state is sound, and nothing is known of its block.
  void import_block(const BlockState& state);

  LogOddsCells& values() { return values_; }
  const LogOddsCells& values() const { return values_; }

  // Blocks that are held: absent and free ones are not.
  std::uint32_t block_count() const { return pool_.in_use(); }
  std::size_t memory_bytes() const;

  BlockStore() = default;
  BlockStore(const BlockStore& other);
  BlockStore& operator=(const BlockStore& other);
  BlockStore(BlockStore&&) noexcept = default;
  BlockStore& operator=(BlockStore&&) noexcept = default;
  ~BlockStore() = default;

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> region_index_;
  std::vector<std::unique_ptr<Region>> regions_;
  std::vector<std::uint32_t> last_changes_;
  ChunkedPool<Block, 64> pool_;
  LogOddsCells values_;
  ChunkedPool<BlockCosts, 64> block_costs_;
  CostCells costs_;
};

}  // namespace warren
