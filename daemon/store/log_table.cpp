// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/log_table.hpp"

#include <algorithm>
#include <set>

namespace warren {

void LogTable::load() {
  entries_.clear();
  by_row_.clear();
  own_ = 0;
  heads_.for_each(0, kAllRows, [&](std::int64_t row, ByteView bytes) {
    auto head = decode_item_head(bytes);
    if (!head) return false;
    const LogItemId id = head->id;
    own_ += head->own ? 1 : 0;
    by_row_[row] = id;
    return entries_.try_emplace(id, Entry{row, std::move(*head)}).second;
  });
}

std::size_t LogTable::verify() {
  std::size_t items = 0;
  bool all_known = true;
  bytes_.for_each(0, kAllRows, [&](std::int64_t row, ByteView) {
    ++items;
    all_known = all_known && by_row_.contains(row);
    return all_known;
  });
  // A head without bytes shows as a row that is not there.
  if (items != by_row_.size()) {
    bytes_.for_each(0, kAllRows, [](std::int64_t, ByteView) { return false; });
  }
  return items;
}

BatchResult LogTable::judge(const StoreBatch& batch) const {
  std::set<LogItemId> own_new;
  for (const LogItem& item : batch.items) {
    const bool sound = item.bytes.size() <= kItemBytesMax && item.receipts.size() <= kReceiptsMax &&
                       std::is_sorted(item.receipts.begin(), item.receipts.end());
    if (!sound) return BatchResult::kUnsound;
    if (!item.own) continue;
    if (entries_.contains(item.id) || !own_new.insert(item.id).second) {
      return BatchResult::kSequenceReused;
    }
  }
  return own_ + own_new.size() <= kLogItemsMax ? BatchResult::kStored : BatchResult::kTooManyItems;
}

void LogTable::put(const LogItem& item, Evictions& evicted) {
  if (entries_.contains(item.id)) return;
  if (entries_.size() >= kLogItemsMax) {
    auto victims = evict(true, kEvictedAtOnce);
    if (victims.empty()) victims = evict(false, kEvictedAtOnce);
    evicted.items.insert(evicted.items.end(), victims.begin(), victims.end());
  }
  Entry entry{by_row_.empty() ? 0 : by_row_.rbegin()->first + 1, item};
  entry.head.bytes.clear();
  heads_.put(entry.row, encode_item_head(entry.head));
  bytes_.put(entry.row, item.bytes);
  own_ += item.own ? 1 : 0;
  by_row_[entry.row] = item.id;
  entries_[item.id] = std::move(entry);
}

void LogTable::receive(const LogReceipt& receipt) {
  const auto found = entries_.find(receipt.item);
  if (found == entries_.end()) return;
  std::vector<MemberId>& receipts = found->second.head.receipts;
  const auto place = std::lower_bound(receipts.begin(), receipts.end(), receipt.from);
  if (place != receipts.end() && *place == receipt.from) return;
  if (receipts.size() == kReceiptsMax) return;
  receipts.insert(place, receipt.from);
  heads_.put(found->second.row, encode_item_head(found->second.head));
}

void LogTable::erase(const LogItemId& id) {
  const auto found = entries_.find(id);
  if (found == entries_.end()) return;
  const std::int64_t row = found->second.row;
  heads_.erase(row, row + 1);
  bytes_.erase(row, row + 1);
  own_ -= found->second.head.own ? 1 : 0;
  by_row_.erase(row);
  entries_.erase(found);
}

std::vector<LogItemId> LogTable::evict(bool done_only, std::size_t most) {
  std::vector<LogItemId> victims;
  for (const auto& [row, id] : by_row_) {
    if (victims.size() == most) break;
    const LogItem& head = entries_.at(id).head;
    if (!head.own && (!done_only || is_done(head))) victims.push_back(id);
  }
  for (const LogItemId& id : victims) erase(id);
  return victims;
}

std::vector<LogItem> LogTable::items() {
  std::vector<LogItem> items;
  for (const auto& [row, id] : by_row_) {
    items.push_back(entries_.at(id).head);
    if (auto bytes = bytes_.get(row)) items.back().bytes = std::move(*bytes);
  }
  return items;
}

bool LogTable::is_done(const LogItem& item) {
  return item.destination &&
         std::binary_search(item.receipts.begin(), item.receipts.end(), *item.destination);
}

}  // namespace warren
