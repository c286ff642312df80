// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/self_table.hpp"

#include <algorithm>
#include <limits>

#include "daemon/store/block_bytes.hpp"
#include "daemon/store/layer_table.hpp"

namespace warren {

void SelfTable::load() {
  entries_.clear();
  heads_.for_each(0, kSlotsMax, [&](std::int64_t number, ByteView bytes) {
    auto head = decode_self_head(bytes);
    if (!head || head->number != number) return false;
    entries_[head->number] = std::move(*head);
    return true;
  });
}

std::size_t SelfTable::verify() {
  std::size_t blocks = 0;
  blocks_.for_each(
      0, std::numeric_limits<std::int64_t>::max(), [&](std::int64_t row, ByteView bytes) {
        const auto layer = entries_.find(static_cast<std::uint32_t>(row >> kOrdinalBits));
        const auto block = decode_self_block(block_of_row(row), bytes);
        ++blocks;
        return layer != entries_.end() && block && block->changed_at <= layer->second.cursor;
      });
  return blocks;
}

BatchResult SelfTable::judge(const SelfLayerWrite& write) const {
  const SelfLayerHead& head = write.head;
  if (head.number >= kSlotsMax || !decode_self_head(encode_self_head(head))) {
    return BatchResult::kUnsound;
  }
  const bool sound = std::all_of(
      write.blocks.begin(), write.blocks.end(),
      [&](const BlockState& block) { return block.is_sound() && block.changed_at <= head.cursor; });
  const auto found = entries_.find(head.number);
  if (!sound) return BatchResult::kUnsound;
  if (found == entries_.end()) return BatchResult::kStored;
  SelfLayerHead before = found->second;
  if (head.cursor < before.cursor) return BatchResult::kUnsound;
  // Only these may change.
  before.scans = head.scans;
  before.cursor = head.cursor;
  before.T_fleet_map = head.T_fleet_map;
  before.gravity_map = head.gravity_map;
  return before == head ? BatchResult::kStored : BatchResult::kUnsound;
}

void SelfTable::write(const SelfLayerWrite& write) {
  entries_[write.head.number] = write.head;
  heads_.put(write.head.number, encode_self_head(write.head));
  for (const BlockState& block : write.blocks) {
    blocks_.put(block_row(write.head.number, ordinal_of(block.key)), encode_self_block(block));
  }
}

std::vector<SelfLayerHead> SelfTable::heads() const {
  std::vector<SelfLayerHead> heads;
  for (const auto& [number, head] : entries_) heads.push_back(head);
  return heads;
}

bool SelfTable::fill(const SelfLayerHead& head, SelfMap& map) {
  bool could_be = true;
  blocks_.for_each(block_row(head.number, 0), block_row(head.number + std::int64_t{1}, 0),
                   [&](std::int64_t row, ByteView bytes) {
                     const auto block = decode_self_block(block_of_row(row), bytes);
                     could_be = block && map.import_block(*block);
                     return could_be;
                   });
  map.import_cursor(head.cursor);
  return could_be;
}

}  // namespace warren
