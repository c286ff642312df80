// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/store/database.hpp"
#include "daemon/store/sealed_bytes.hpp"

namespace warren {

// The end behind every key.
inline constexpr std::int64_t kAllRows = std::numeric_limits<std::int64_t>::max();

// Rows of bytes by a number, each sealed. All tables of a store are such.
class RowTable {
 public:
  RowTable(Database& database, const std::string& name);

  // In place of what was there.
  void put(std::int64_t key, std::vector<std::uint8_t> bytes);
  void erase(std::int64_t first, std::int64_t end);
  std::optional<std::vector<std::uint8_t>> get(std::int64_t key);
  // Calls visit(key, bytes) by rising key as long as it returns true; false counts as a corrupt
  // file, as does a row whose seal is broken.
  template <typename Visit>
  void for_each(std::int64_t first, std::int64_t end, Visit&& visit);

 private:
  Database& database_;
  std::string name_;
  Statement put_;
  Statement erase_;
  Statement get_;
};

template <typename Visit>
void RowTable::for_each(std::int64_t first, std::int64_t end, Visit&& visit) {
  const std::string sql =
      "SELECT key, data FROM " + name_ + " WHERE key >= ?1 AND key < ?2 ORDER BY key";
  Statement rows(database_, sql.c_str());
  rows.bind(1, first).bind(2, end);
  while (rows.step()) {
    const std::int64_t key = rows.number(0);
    const auto bytes = unsealed(key, rows.bytes(1));
    if (bytes && visit(key, *bytes)) continue;
    database_.fail(StoreError::kCorrupt, "row " + std::to_string(key) + " of " + name_ +
                                             (bytes ? " makes no sense" : " is damaged"));
  }
}

}  // namespace warren
