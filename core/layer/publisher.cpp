// SPDX-License-Identifier: Apache-2.0
#include "core/layer/publisher.hpp"

#include "core/voxel/bits.hpp"

namespace warren {

CodeBlock codes_of(const SelfMap& map, const BlockKey& key) {
  const BlockStore& store = map.blocks();
  const BlockSlot slot = store.slot_of(key);
  BlockCodes codes;
  if (slot == kAbsentBlock) return {};
  if (slot == kFreeBlock) {
    codes.known.fill(kFullCell);
    return CodeBlock(codes);
  }
  const Block& block = store.block(slot);
  codes.known = block.known;
  codes.occupied = block.occupied;
  for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(block.occupied[cell], [&](std::uint32_t bit) {
      const std::uint32_t place = cell << 6 | bit;
      codes.costs[place] = encode_cost(store.cost(block, place));
    });
  }
  return CodeBlock(codes);
}

std::vector<CodedBlock> blocks_changed_since(const SelfMap& map, std::uint32_t cursor) {
  const std::vector<BlockKey> keys = map.blocks_changed_since(cursor);
  std::vector<CodedBlock> changed;
  changed.reserve(keys.size());
  for (const BlockKey& key : keys) changed.push_back({ordinal_of(key), codes_of(map, key)});
  return changed;
}

}  // namespace warren
