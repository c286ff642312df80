// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/layer_table.hpp"

#include <algorithm>

#include "daemon/store/block_bytes.hpp"

namespace warren {
namespace {

// Where less is held than before, and it was not forgotten.
bool lowers(const Holdings& before, const LayerWrite& write) {
  const auto lower_at = [&](BlockOrdinal block) {
    const bool forgotten =
        std::any_of(write.forgotten.begin(), write.forgotten.end(),
                    [&](const KeyInterval& keys) { return keys.contains(block); });
    return !forgotten && write.head.holdings.at(block) < before.at(block);
  };
  // What is held, and what forgotten, changes only at these.
  const auto any_lower = [&](std::span<const Holdings::Interval> intervals) {
    return std::any_of(intervals.begin(), intervals.end(),
                       [&](const auto& interval) { return lower_at(interval.first); });
  };
  return any_lower(before.intervals()) || any_lower(write.head.holdings.intervals()) ||
         std::any_of(write.forgotten.begin(), write.forgotten.end(), [&](const auto& keys) {
           return keys.end < kOrdinalEnd && lower_at(keys.end);
         });
}

bool is_sound(const LayerWrite& write) {
  const auto forgotten_sound = [](const KeyInterval& keys) {
    return !keys.empty() && keys.end <= kOrdinalEnd;
  };
  const auto block_sound = [&](const StoredBlock& block) {
    return block.block < kOrdinalEnd && Revision{} < block.changed_at &&
           block.changed_at <= write.head.holdings.at(block.block);
  };
  return std::all_of(write.forgotten.begin(), write.forgotten.end(), forgotten_sound) &&
         std::all_of(write.blocks.begin(), write.blocks.end(), block_sound);
}

// Every revision is written once, whole, and above the one before.
BatchResult judge_own(const LayerRow& before, const LayerWrite& write) {
  if (before.closed) return BatchResult::kLayerClosed;
  if (write.head.holdings.intervals().size() != 1 || !write.forgotten.empty()) {
    return BatchResult::kUnsound;
  }
  const Revision stored = before.head.holdings.at(0);
  const Revision now = write.head.holdings.at(0);
  const bool no_old_revision =
      std::all_of(write.blocks.begin(), write.blocks.end(),
                  [&](const StoredBlock& block) { return stored < block.changed_at; });
  return stored <= now && no_old_revision ? BatchResult::kStored : BatchResult::kRevisionReused;
}

}  // namespace

void LayerTable::load() {
  entries_.clear();
  heads_.for_each(0, kSlotsMax, [&](std::int64_t slot, ByteView bytes) {
    auto row = decode_layer_row(bytes);
    if (!row) return false;
    const LayerId id = row->head.id;
    return entries_.try_emplace(id, Entry{slot, std::move(*row)}).second;
  });
}

std::size_t LayerTable::verify() {
  std::map<std::int64_t, const LayerHead*> heads;
  for (const auto& [id, entry] : entries_) heads[entry.slot] = &entry.row.head;
  std::size_t blocks = 0;
  blocks_.for_each(0, kAllRows, [&](std::int64_t row, ByteView bytes) {
    const auto head = heads.find(row >> kOrdinalBits);
    const auto block = decode_block(block_of_row(row), bytes);
    ++blocks;
    return head != heads.end() && block &&
           block->changed_at <= head->second->holdings.at(block->block);
  });
  return blocks;
}

BatchResult LayerTable::judge(const LayerWrite& write) const {
  if (!is_sound(write)) return BatchResult::kUnsound;
  const auto found = entries_.find(write.head.id);
  if (found == entries_.end()) return BatchResult::kStored;
  const LayerRow& before = found->second.row;
  if (before.head.resolution != write.head.resolution) return BatchResult::kUnsound;
  if (write.head.own && !before.head.own) return BatchResult::kUnsound;
  if (write.head.own) return judge_own(before, write);
  return lowers(before.head.holdings, write) ? BatchResult::kHoldingsLowered : BatchResult::kStored;
}

bool LayerTable::write(const LayerWrite& write, std::uint64_t commit) {
  if (is_evicted(write.head.id)) return false;
  auto found = entries_.find(write.head.id);
  if (found == entries_.end()) {
    found = entries_.try_emplace(write.head.id, Entry{free_slot(), LayerRow{}}).first;
  }
  Entry& held = found->second;
  // An own layer that is written like another's is a copy from now on, which neighbours complete.
  const bool was_own = held.row.head.own;
  held.row.head = write.head;
  held.row.head.own = was_own || write.head.own;
  held.row.closed = held.row.closed || (was_own && !write.head.own);
  held.row.written_at = commit;
  put_head(held);
  for (const KeyInterval& keys : write.forgotten) {
    blocks_.erase(block_row(held.slot, keys.first),
                  block_row(held.slot, 0) + static_cast<std::int64_t>(keys.end));
  }
  for (const StoredBlock& block : write.blocks) {
    blocks_.put(block_row(held.slot, block.block), encode_block(block));
  }
  return true;
}

void LayerTable::erase(const LayerId& id) {
  const auto found = entries_.find(id);
  if (found == entries_.end()) return;
  const std::int64_t slot = found->second.slot;
  heads_.erase(slot, slot + 1);
  blocks_.erase(block_row(slot, 0), block_row(slot + 1, 0));
  entries_.erase(found);
}

void LayerTable::close_own() {
  for (auto& [id, entry] : entries_) {
    if (!entry.row.head.own) continue;
    entry.row.closed = true;
    put_head(entry);
  }
}

std::optional<LayerId> LayerTable::evict_one() {
  const Entry* victim = nullptr;
  for (const auto& [id, entry] : entries_) {
    if (entry.row.head.own) continue;
    if (victim == nullptr || entry.row.written_at < victim->row.written_at) victim = &entry;
  }
  if (victim == nullptr) return std::nullopt;
  const LayerId id = victim->row.head.id;
  erase(id);
  evicting_.insert(id);
  return id;
}

std::vector<LayerRow> LayerTable::rows() const {
  std::vector<LayerRow> rows;
  for (const auto& [id, entry] : entries_) rows.push_back(entry.row);
  return rows;
}

std::vector<StoredBlock> LayerTable::blocks(const LayerId& id) {
  std::vector<StoredBlock> blocks;
  const auto found = entries_.find(id);
  if (found == entries_.end()) return blocks;
  const std::int64_t slot = found->second.slot;
  blocks_.for_each(block_row(slot, 0), block_row(slot + 1, 0),
                   [&](std::int64_t row, ByteView bytes) {
                     auto block = decode_block(block_of_row(row), bytes);
                     if (block) blocks.push_back(std::move(*block));
                     return block.has_value();
                   });
  return blocks;
}

std::int64_t LayerTable::free_slot() const {
  std::set<std::int64_t> taken;
  for (const auto& [id, entry] : entries_) taken.insert(entry.slot);
  std::int64_t slot = 0;
  while (taken.contains(slot)) ++slot;
  return slot;
}

void LayerTable::put_head(const Entry& entry) {
  heads_.put(entry.slot, encode_layer_row(entry.row));
}

}  // namespace warren
