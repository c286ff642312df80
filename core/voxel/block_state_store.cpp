// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>

#include "core/voxel/bits.hpp"
#include "core/voxel/block_state.hpp"
#include "core/voxel/block_store.hpp"

namespace warren {
namespace {

bool is_free_throughout(const BlockState& state) {
  return std::all_of(state.clamped_free.begin(), state.clamped_free.end(),
                     [](std::uint64_t mask) { return mask == kFullCell; });
}

template <typename Value>
void append(std::uint64_t mask, const std::array<Value, 64>& from, std::vector<Value>& to) {
  for_each_bit(mask, [&](std::uint32_t bit) { to.push_back(from[bit]); });
}

// Lays the next numbers out at the mask's places.
template <typename Value>
std::array<Value, 64> laid_out(std::uint64_t mask, const Value*& next) {
  std::array<Value, 64> values{};
  for_each_bit(mask, [&](std::uint32_t bit) { values[bit] = *next++; });
  return values;
}

}  // namespace

std::optional<BlockState> BlockStore::export_block(const BlockKey& key) const {
  const std::uint32_t index = find_region({key.x >> 3, key.y >> 3, key.z >> 3});
  if (index == kNoRegion) return std::nullopt;
  const BlockSlot slot = region(index).slots[slot_in_region(key)];
  if (slot == kAbsentBlock) return std::nullopt;
  BlockState state;
  state.key = key;
  state.changed_at = region(index).changed_at[slot_in_region(key)];
  if (slot == kFreeBlock) {
    state.known.fill(kFullCell);
    state.clamped_free.fill(kFullCell);
    return state;
  }
  const Block& held = block(slot);
  state.known = held.known;
  state.occupied = held.occupied;
  state.clamped_free = held.clamped_free;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    std::array<std::int16_t, 64> values{};
    values_.unpack(held.values[cell], held.stored(cell), values);
    append(held.stored(cell), values, state.values);
    std::array<FusedCost, 64> costs{};
    state.costed[cell] = unpack_costs(held, cell, costs);
    append(state.costed[cell], costs, state.costs);
  }
  return state;
}

void BlockStore::import_block(const BlockState& state) {
  assert(state.is_sound());
  const BlockKey& key = state.key;
  const std::uint32_t index = find_or_add_region({key.x >> 3, key.y >> 3, key.z >> 3});
  const std::uint32_t place = slot_in_region(key);
  BlockSlot& slot = region(index).slots[place];
  assert(slot == kAbsentBlock);
  region(index).changed_at[place] = state.changed_at;
  last_changes_[index] = std::max(last_changes_[index], state.changed_at);
  if (is_free_throughout(state)) {
    slot = kFreeBlock;
    return;
  }
  Block& made = materialise(slot);
  made.known = state.known;
  made.occupied = state.occupied;
  made.clamped_free = state.clamped_free;
  const std::int16_t* next_value = state.values.data();
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    const std::uint64_t stored = state.stored(cell);
    made.values[cell] = values_.repack(0, stored, laid_out(stored, next_value));
  }
  if (state.costs.empty()) return;
  made.costs = block_costs_.allocate() + 1;
  BlockCosts& costs = block_costs_[made.costs - 1];
  costs.costed = state.costed;
  const FusedCost* next_cost = state.costs.data();
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    costs.values[cell] =
        costs_.repack(0, state.costed[cell], laid_out(state.costed[cell], next_cost));
  }
}

}  // namespace warren
