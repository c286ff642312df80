// SPDX-License-Identifier: Apache-2.0
// What the merge-map tells those who keep a copy of it.
#include "core/layer/merge_map.hpp"

namespace warren {
namespace {

BlockBox blocks_of_region(const VoxelKey& region) {
  const BlockKey low{region.x * 8, region.y * 8, region.z * 8};
  return {low, {low.x + 7, low.y + 7, low.z + 7}};
}

bool intersect(const BlockBox& a, const BlockBox& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

constexpr BlockBox kAllBlocks{block_of({kKeyMin, kKeyMin, kKeyMin}),
                              block_of({kKeyMax, kKeyMax, kKeyMax})};

}  // namespace

std::optional<std::vector<BlockKey>> MergeMap::blocks_changed_since(std::uint64_t cursor) const {
  if (!remembers(cursor)) return std::nullopt;
  std::vector<BlockKey> changed;
  for_each_changed_block(cursor, kAllBlocks, 0, [&](const BlockKey& block) {
    changed.push_back(block);
    return true;
  });
  return changed;
}

void MergeMap::for_each_changed_block(std::uint64_t cursor, const BlockBox& box, BlockOrdinal first,
                                      const BlockVisitor& visit) const {
  if (cursor >= changes_) return;
  for (const MergeIndex::Region* const region : index_.regions_changed_after(cursor)) {
    const BlockBox blocks = blocks_of_region(region->key);
    if (ordinal_of(blocks.high) < first || !intersect(blocks, box)) continue;
    for (std::uint32_t slot = 0; slot < kBlocksPerRegion; ++slot) {
      if (region->touches[slot].changed_at <= cursor) continue;
      const BlockKey block = block_in_region(region->key, slot);
      if (ordinal_of(block) < first || !box.index_of(block)) continue;
      if (!visit(block)) return;
    }
  }
}

std::array<VoxelCode, kVoxelsPerBlock> MergeMap::codes(const BlockKey& block) {
  std::array<VoxelCode, kVoxelsPerBlock> codes{};
  MergeEntry* const entry = index_.find(first_voxel_of(block));
  if (entry == nullptr) return codes;
  if (!entry->is_derived()) derive(*entry, block);
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    codes[place] = voxel_of(*entry, place).code;
  }
  return codes;
}

}  // namespace warren
