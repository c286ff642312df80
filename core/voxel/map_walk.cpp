// SPDX-License-Identifier: Apache-2.0
// Reading a self-map as a whole: known voxels, counts, bounds.
#include <algorithm>
#include <bit>

#include "core/voxel/bits.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {
namespace {

bool touches(const KeyBox& box, const VoxelKey& low, std::int32_t edge) {
  return low.x <= box.high.x && low.x + edge > box.low.x && low.y <= box.high.y &&
         low.y + edge > box.low.y && low.z <= box.high.z && low.z + edge > box.low.z;
}

// Calls visit(BlockKey, BlockSlot) for every block in the box of which anything is known.
template <typename Visit>
void for_each_block(const BlockStore& store, const KeyBox& box, Visit&& visit) {
  for (const std::uint32_t index : store.regions_in_order()) {
    const Region& region = store.region(index);
    const VoxelKey low{region.key.x * kRegionEdge, region.key.y * kRegionEdge,
                       region.key.z * kRegionEdge};
    if (!touches(box, low, kRegionEdge)) continue;
    for (std::uint32_t slot = 0; slot < kBlocksPerRegion; ++slot) {
      if (region.slots[slot] == kAbsentBlock) continue;
      const BlockKey key = block_in_region(region.key, slot);
      if (touches(box, first_voxel_of(key), kBlockEdge)) visit(key, region.slots[slot]);
    }
  }
}

std::uint64_t& count_for(CostCounts& counts, const FusedCost& cost) {
  if (cost.cost * 10 <= FusedCost::kImpossible) return counts.up_to_0p10;
  return cost.cost * 5 <= FusedCost::kImpossible ? counts.up_to_0p20 : counts.above_0p20;
}

VoxelKey voxel_in_block(const BlockKey& block, std::uint32_t place) {
  const VoxelKey first = first_voxel_of(block);
  const VoxelKey inside = place_of_morton9(place);
  return {first.x + inside.x, first.y + inside.y, first.z + inside.z};
}

}  // namespace

void SelfMap::for_each_known_voxel(const KeyBox& box, const VoxelVisitor& visit) const {
  const float free_clamp = model_.log_odds(model_.minimum);
  for_each_block(store_, box, [&](const BlockKey& key, BlockSlot slot) {
    for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
      std::array<std::int16_t, 64> values{};
      std::uint64_t known = kFullCell;
      std::uint64_t occupied = 0;
      std::uint64_t stored = 0;
      if (slot != kFreeBlock) {
        const Block& block = store_.block(slot);
        known = block.known[cell];
        occupied = block.occupied[cell];
        stored = block.stored(cell);
        store_.values().unpack(block.values[cell], stored, values);
      }
      for_each_bit(known, [&](std::uint32_t bit) {
        const VoxelKey voxel = voxel_in_block(key, cell << 6 | bit);
        if (!box.contains(voxel)) return;
        const bool is_occupied = (occupied >> bit & 1) != 0;
        const bool has_value = (stored >> bit & 1) != 0;
        visit(voxel, is_occupied ? VoxelState::kOccupied : VoxelState::kFree,
              has_value ? model_.log_odds(values[bit]) : free_clamp);
      });
    }
  });
}

MapCounts SelfMap::counts() const {
  MapCounts counts;
  for_each_block(store_, KeyBox{}, [&](const BlockKey&, BlockSlot slot) {
    ++counts.blocks;
    if (slot == kFreeBlock) {
      counts.free += kCellsPerBlock * 64;
      return;
    }
    const Block& block = store_.block(slot);
    for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
      const std::uint64_t free = block.known[cell] & ~block.occupied[cell];
      counts.free += static_cast<std::uint64_t>(std::popcount(free));
      counts.occupied += static_cast<std::uint64_t>(std::popcount(block.occupied[cell]));
    }
  });
  return counts;
}

CostCounts SelfMap::cost_counts() const {
  CostCounts counts;
  for_each_block(store_, KeyBox{}, [&](const BlockKey&, BlockSlot slot) {
    if (slot == kFreeBlock) return;
    const Block& block = store_.block(slot);
    for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
      std::array<FusedCost, 64> costs;  // only what the mask names is set
      const std::uint64_t costed = store_.unpack_costs(block, cell, costs);
      counts.no_data += static_cast<std::uint64_t>(std::popcount(block.occupied[cell] & ~costed));
      for_each_bit(block.occupied[cell] & costed,
                   [&](std::uint32_t bit) { ++count_for(counts, costs[bit]); });
    }
  });
  return counts;
}

std::optional<KeyBox> SelfMap::bounds() const {
  std::optional<KeyBox> bounds;
  for_each_block(store_, KeyBox{}, [&](const BlockKey& key, BlockSlot) {
    const VoxelKey low = first_voxel_of(key);
    const VoxelKey high{low.x + kBlockEdge - 1, low.y + kBlockEdge - 1, low.z + kBlockEdge - 1};
    if (!bounds) bounds = KeyBox{low, high};
    bounds->low = {std::min(bounds->low.x, low.x), std::min(bounds->low.y, low.y),
                   std::min(bounds->low.z, low.z)};
    bounds->high = {std::max(bounds->high.x, high.x), std::max(bounds->high.y, high.y),
                    std::max(bounds->high.z, high.z)};
  });
  return bounds;
}

}  // namespace warren
