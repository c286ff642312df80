// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "daemon/store/head_bytes.hpp"
#include "daemon/store/row_table.hpp"
#include "daemon/store/store_result.hpp"

namespace warren {

inline constexpr std::size_t kLogItemsMax = 65536;
inline constexpr std::size_t kReceiptsMax = 256;  // of one item; more are ignored
inline constexpr std::size_t kEvictedAtOnce = 256;
inline constexpr std::size_t kItemBytesMax = std::size_t{16} << 20;

// Items of the logs of all origins. Heads are held in memory too, the bytes on disk alone.
class LogTable {
 public:
  explicit LogTable(Database& database)
      : heads_(database, "log_item"), bytes_(database, "log_bytes") {}

  // The heads, read anew.
  void load();
  // Reads every item; how many there are.
  std::size_t verify();

  BatchResult judge(const StoreBatch& batch) const;
  // Precondition: judged as kStored. An item that is there already stays as it is.
  void put(const LogItem& item, Evictions& evicted);
  void receive(const LogReceipt& receipt);
  void erase(const LogItemId& id);
  // Of the items of others, at most so many, stored longest ago first. Done: its destination has
  // it.
  std::vector<LogItemId> evict(bool done_only, std::size_t most);

  // In the order in which they were stored.
  std::vector<LogItem> items();

 private:
  struct Entry {
    std::int64_t row = 0;
    LogItem head;  // without bytes
  };

  static bool is_done(const LogItem& item);

  RowTable heads_;
  RowTable bytes_;
  std::map<LogItemId, Entry> entries_;
  std::map<std::int64_t, LogItemId> by_row_;  // rows rise with every item
  std::size_t own_ = 0;
};

}  // namespace warren
