// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/block_store.hpp"

#include <algorithm>
#include <utility>

namespace warren {
namespace {

// Regions per axis: 1024. Interleaves the bits of three keys moved to 0..1023: a hash key and the
// Morton order in one.
std::uint64_t region_code(const VoxelKey& region) {
  const auto spread = [](std::int32_t key) {
    std::uint64_t bits = static_cast<std::uint32_t>(key + 512) & 0x3FFU;
    bits = (bits | bits << 16) & 0x30000FFULL;
    bits = (bits | bits << 8) & 0x300F00FULL;
    bits = (bits | bits << 4) & 0x30C30C3ULL;
    return (bits | bits << 2) & 0x9249249ULL;
  };
  return spread(region.x) | spread(region.y) << 1 | spread(region.z) << 2;
}

}  // namespace

BlockStore::BlockStore(const BlockStore& other)
    : region_index_(other.region_index_),
      last_changes_(other.last_changes_),
      pool_(other.pool_),
      values_(other.values_),
      block_costs_(other.block_costs_),
      costs_(other.costs_) {
  regions_.reserve(other.regions_.size());
  for (const auto& region : other.regions_) regions_.push_back(std::make_unique<Region>(*region));
}

BlockStore& BlockStore::operator=(const BlockStore& other) {
  if (this != &other) *this = BlockStore(other);
  return *this;
}

std::uint32_t BlockStore::find_region(const VoxelKey& region) const {
  const auto found = region_index_.find(region_code(region));
  return found == region_index_.end() ? kNoRegion : found->second;
}

std::uint32_t BlockStore::find_or_add_region(const VoxelKey& region) {
  const auto [entry, added] = region_index_.try_emplace(region_code(region), region_count());
  if (added) {
    regions_.push_back(std::make_unique<Region>());
    regions_.back()->key = region;
    last_changes_.push_back(0);
  }
  return entry->second;
}

std::vector<std::uint32_t> BlockStore::regions_in_order() const {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> coded(region_index_.begin(),
                                                             region_index_.end());
  std::sort(coded.begin(), coded.end());
  std::vector<std::uint32_t> indices;
  indices.reserve(coded.size());
  for (const auto& [code, index] : coded) indices.push_back(index);
  return indices;
}

BlockSlot BlockStore::slot_of(const BlockKey& key) const {
  const std::uint32_t index = find_region({key.x >> 3, key.y >> 3, key.z >> 3});
  return index == kNoRegion ? kAbsentBlock : region(index).slots[slot_in_region(key)];
}

VoxelState BlockStore::state(const VoxelKey& key) const {
  const BlockSlot slot = slot_of(block_of(key));
  if (slot == kAbsentBlock) return VoxelState::kUnknown;
  if (slot == kFreeBlock) return VoxelState::kFree;
  const std::uint32_t place = morton9(key.x, key.y, key.z);
  const std::uint64_t bit = std::uint64_t{1} << (place & 63);
  const Block& held = block(slot);
  if ((held.known[place >> 6] & bit) == 0) return VoxelState::kUnknown;
  return (held.occupied[place >> 6] & bit) != 0 ? VoxelState::kOccupied : VoxelState::kFree;
}

std::optional<std::int16_t> BlockStore::value(const VoxelKey& key, std::int16_t minimum) const {
  const BlockSlot slot = slot_of(block_of(key));
  if (slot == kAbsentBlock) return std::nullopt;
  if (slot == kFreeBlock) return minimum;
  const std::uint32_t place = morton9(key.x, key.y, key.z);
  const std::uint64_t bit = std::uint64_t{1} << (place & 63);
  const std::size_t cell = place >> 6;
  const Block& held = block(slot);
  if ((held.known[cell] & bit) == 0) return std::nullopt;
  if ((held.clamped_free[cell] & bit) != 0) return minimum;
  return values_.value(held.values[cell], held.stored(cell), place & 63);
}

std::optional<FusedCost> BlockStore::cost(const Block& block, std::uint32_t place) const {
  if (block.costs == 0) return std::nullopt;
  const BlockCosts& costs = block_costs_[block.costs - 1];
  const std::size_t cell = place >> 6;
  if ((costs.costed[cell] >> (place & 63) & 1) == 0) return std::nullopt;
  return costs_.value(costs.values[cell], costs.costed[cell], place & 63);
}

std::uint64_t BlockStore::unpack_costs(const Block& block, std::size_t cell,
                                       std::array<FusedCost, 64>& costs) const {
  if (block.costs == 0) return 0;
  const BlockCosts& held = block_costs_[block.costs - 1];
  costs_.unpack(held.values[cell], held.costed[cell], costs);
  return held.costed[cell];
}

void BlockStore::set_cost(Block& block, std::uint32_t place, const FusedCost& cost) {
  if (block.costs == 0) block.costs = block_costs_.allocate() + 1;
  BlockCosts& costs = block_costs_[block.costs - 1];
  const std::size_t cell = place >> 6;
  const std::uint32_t bit = place & 63;
  if (const std::uint64_t mask = std::uint64_t{1} << bit; (costs.costed[cell] & mask) == 0) {
    std::array<FusedCost, 64> values{};
    costs_.unpack(costs.values[cell], costs.costed[cell], values);
    costs.costed[cell] |= mask;
    costs.values[cell] = costs_.repack(costs.values[cell], costs.costed[cell], values);
  }
  costs_.value(costs.values[cell], costs.costed[cell], bit) = cost;
}

void BlockStore::forget_costs_at_clamp(Block& block) {
  if (block.costs == 0) return;
  BlockCosts& costs = block_costs_[block.costs - 1];
  std::uint64_t any = 0;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    const std::uint64_t left = costs.costed[cell] & ~block.clamped_free[cell];
    any |= left;
    if (left == costs.costed[cell]) continue;
    std::array<FusedCost, 64> values{};
    costs_.unpack(costs.values[cell], costs.costed[cell], values);
    costs.costed[cell] = left;
    costs.values[cell] = costs_.repack(costs.values[cell], left, values);
  }
  if (any != 0) return;
  block_costs_.release(block.costs - 1);
  block.costs = 0;
}

Block& BlockStore::materialise(BlockSlot& slot) {
  if (slot >= kFirstBlockSlot) return block(slot);
  const bool was_free = slot == kFreeBlock;
  slot = pool_.allocate() + kFirstBlockSlot;
  Block& made = block(slot);
  if (was_free) {
    made.known.fill(kFullCell);
    made.clamped_free.fill(kFullCell);
  }
  return made;
}

void BlockStore::collapse_if_free(BlockSlot& slot) {
  if (slot < kFirstBlockSlot) return;
  const Block& held = block(slot);
  const bool free = std::all_of(held.clamped_free.begin(), held.clamped_free.end(),
                                [](std::uint64_t mask) { return mask == kFullCell; });
  if (!free) return;
  pool_.release(slot - kFirstBlockSlot);
  slot = kFreeBlock;
}

std::size_t BlockStore::memory_bytes() const {
  // A node and a bucket of the hash are about 32 bytes.
  return pool_.memory_bytes() + values_.memory_bytes() + block_costs_.memory_bytes() +
         costs_.memory_bytes() + region_index_.size() * 32 +
         regions_.capacity() * sizeof(regions_[0]) + regions_.size() * sizeof(Region) +
         last_changes_.capacity() * sizeof(last_changes_[0]);
}

}  // namespace warren
