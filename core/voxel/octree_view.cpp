// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/octree_view.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

namespace warren {
namespace {

using Visit = std::function<void(const OctreeLeaf&)>;

constexpr int kBlockLevel = 3;
constexpr int kRegionLevel = 6;

// Which states occur in a cube.
struct Summary {
  bool unknown = false;
  bool free = false;
  bool occupied = false;

  bool uniform() const { return (unknown ? 1 : 0) + (free ? 1 : 0) + (occupied ? 1 : 0) == 1; }
  bool all_seen() const { return unknown && free && occupied; }
  VoxelState state() const {
    if (occupied) return VoxelState::kOccupied;
    return free ? VoxelState::kFree : VoxelState::kUnknown;
  }
  Summary& operator|=(const Summary& other) {
    unknown |= other.unknown;
    free |= other.free;
    occupied |= other.occupied;
    return *this;
  }
};

constexpr Summary kUnknownSummary{true, false, false};
constexpr Summary kFreeSummary{false, true, false};

// Bits [first, first + count) of a cell.
Summary summary_of_bits(const Block& block, std::size_t cell, std::uint32_t first, int count) {
  const std::uint64_t mask = (count == 64 ? kFullCell : (std::uint64_t{1} << count) - 1) << first;
  const std::uint64_t known = block.known[cell] & mask;
  return {known != mask, (known & ~block.occupied[cell]) != 0, (block.occupied[cell] & mask) != 0};
}

Summary summary_of_block(const BlockStore& store, BlockSlot slot) {
  if (slot == kAbsentBlock) return kUnknownSummary;
  if (slot == kFreeBlock) return kFreeSummary;
  Summary summary;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    summary |= summary_of_bits(store.block(slot), cell, 0, 64);
  }
  return summary;
}

Summary summary_of_slots(const BlockStore& store, const Region& region, std::uint32_t first,
                         std::uint32_t count) {
  Summary summary;
  for (std::uint32_t slot = first; slot < first + count && !summary.all_seen(); ++slot) {
    summary |= summary_of_block(store, region.slots[slot]);
  }
  return summary;
}

VoxelKey offset_by(const VoxelKey& low, std::uint32_t child, int child_level) {
  const std::int32_t edge = 1 << child_level;
  return {low.x + ((child & 1) != 0 ? edge : 0), low.y + ((child & 2) != 0 ? edge : 0),
          low.z + ((child & 4) != 0 ? edge : 0)};
}

// Walks the tree from the top; every step down names the part of the storage that it stands on.
class LeafWalk {
 public:
  LeafWalk(const BlockStore& store, int min_level, const Visit& visit)
      : store_(store), min_level_(min_level), visit_(visit) {}

  // Regions [first, last) in Morton order are all that is known of the cube.
  void walk_regions(const VoxelKey& low, int level, const std::vector<std::uint32_t>& regions,
                    std::size_t first, std::size_t last) const {
    if (first == last) return;
    if (level == kRegionLevel) return walk_region(low, store_.region(regions[first]));
    const std::size_t complete = std::size_t{1} << (3 * (level - kRegionLevel));
    Summary summary = last - first < complete ? kUnknownSummary : Summary{};
    for (std::size_t i = first; i < last && !summary.all_seen(); ++i) {
      summary |= summary_of_slots(store_, store_.region(regions[i]), 0, kBlocksPerRegion);
    }
    if (emit(low, level, summary)) return;
    for (std::uint32_t child = 0; child < 8; ++child) {
      const VoxelKey child_low = offset_by(low, child, level - 1);
      const std::size_t end = end_of_cube(child_low, level - 1, regions, first, last);
      walk_regions(child_low, level - 1, regions, first, end);
      first = end;
    }
  }

 private:
  // Whether the cube is a leaf; a known one is visited.
  bool emit(const VoxelKey& low, int level, const Summary& summary) const {
    if (!summary.uniform() && level > min_level_) return false;
    if (summary.state() != VoxelState::kUnknown) visit_({low, level, summary.state()});
    return true;
  }

  std::size_t end_of_cube(const VoxelKey& low, int level, const std::vector<std::uint32_t>& regions,
                          std::size_t first, std::size_t last) const {
    const KeyBox cube{
        low, {low.x + (1 << level) - 1, low.y + (1 << level) - 1, low.z + (1 << level) - 1}};
    while (first < last) {
      const VoxelKey& key = store_.region(regions[first]).key;
      if (!cube.contains({key.x * kRegionEdge, key.y * kRegionEdge, key.z * kRegionEdge})) break;
      ++first;
    }
    return first;
  }

  void walk_region(const VoxelKey& low, const Region& region) const {
    walk_slots(low, kRegionLevel, region, 0);
  }

  void walk_slots(const VoxelKey& low, int level, const Region& region, std::uint32_t first) const {
    const std::uint32_t count = 1U << (3 * (level - kBlockLevel));
    if (emit(low, level, summary_of_slots(store_, region, first, count))) return;
    if (level == kBlockLevel) return walk_bits(low, level, store_.block(region.slots[first]), 0);
    for (std::uint32_t child = 0; child < 8; ++child) {
      walk_slots(offset_by(low, child, level - 1), level - 1, region, first + child * count / 8);
    }
  }

  // Children of a cube within a block that is no leaf; `first` counts voxels in Morton order.
  void walk_bits(const VoxelKey& low, int level, const Block& block, std::uint32_t first) const {
    const int child_level = level - 1;
    const int count = 1 << (3 * child_level);
    for (std::uint32_t child = 0; child < 8; ++child) {
      const std::uint32_t voxel = first + child * static_cast<std::uint32_t>(count);
      const VoxelKey child_low = offset_by(low, child, child_level);
      const Summary summary = summary_of_bits(block, voxel >> 6, voxel & 63, count);
      if (!emit(child_low, child_level, summary)) walk_bits(child_low, child_level, block, voxel);
    }
  }

  const BlockStore& store_;
  int min_level_;
  const Visit& visit_;
};

Summary summary_within_block(const Block& block, const VoxelKey& key, int level) {
  const std::uint32_t place = morton9(key.x, key.y, key.z) & ~((1U << (3 * level)) - 1);
  return summary_of_bits(block, place >> 6, place & 63, 1 << (3 * level));
}

}  // namespace

VoxelState OctreeView::state(const VoxelKey& key, int level) const {
  assert(level >= 0 && level <= kRootLevel);
  const BlockStore& store = map_->blocks();
  if (level < kBlockLevel) {
    const BlockSlot slot = store.slot_of(block_of(key));
    if (slot == kAbsentBlock) return VoxelState::kUnknown;
    if (slot == kFreeBlock) return VoxelState::kFree;
    return summary_within_block(store.block(slot), key, level).state();
  }
  const std::uint32_t count = 1U << (3 * (std::min(level, kRegionLevel) - kBlockLevel));
  if (level <= kRegionLevel) {
    const std::uint32_t index = store.find_region(region_of(key));
    if (index == BlockStore::kNoRegion) return VoxelState::kUnknown;
    const std::uint32_t first = slot_in_region(block_of(key)) & ~(count - 1);
    return summary_of_slots(store, store.region(index), first, count).state();
  }
  Summary summary;
  const int shift = level - kRegionLevel;
  const VoxelKey cube{key.x >> level, key.y >> level, key.z >> level};
  for (std::uint32_t index = 0; index < store.region_count(); ++index) {
    const Region& region = store.region(index);
    const VoxelKey around{region.key.x >> shift, region.key.y >> shift, region.key.z >> shift};
    if (around == cube) summary |= summary_of_slots(store, region, 0, count);
  }
  return summary.state();
}

void OctreeView::for_each_leaf(int min_level, const Visit& visit) const {
  assert(min_level >= 0 && min_level <= kRootLevel);
  const std::vector<std::uint32_t> regions = map_->blocks().regions_in_order();
  LeafWalk(map_->blocks(), min_level, visit)
      .walk_regions({kKeyMin, kKeyMin, kKeyMin}, kRootLevel, regions, 0, regions.size());
}

}  // namespace warren
