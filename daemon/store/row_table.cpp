// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/row_table.hpp"

#include <utility>

namespace warren {

RowTable::RowTable(Database& database, const std::string& name)
    : database_(database),
      name_(name),
      put_(database, ("INSERT OR REPLACE INTO " + name + " (key, data) VALUES (?1, ?2)").c_str()),
      erase_(database, ("DELETE FROM " + name + " WHERE key >= ?1 AND key < ?2").c_str()),
      get_(database, ("SELECT data FROM " + name + " WHERE key = ?1").c_str()) {}

void RowTable::put(std::int64_t key, std::vector<std::uint8_t> bytes) {
  seal(key, bytes);
  put_.bind(1, key).bind(2, bytes).step();
}

void RowTable::erase(std::int64_t first, std::int64_t end) {
  erase_.bind(1, first).bind(2, end).step();
}

std::optional<std::vector<std::uint8_t>> RowTable::get(std::int64_t key) {
  std::optional<std::vector<std::uint8_t>> found;
  if (!get_.bind(1, key).step()) return found;
  if (const auto bytes = unsealed(key, get_.bytes(0))) {
    found.emplace(bytes->begin(), bytes->end());
  } else {
    database_.fail(StoreError::kCorrupt,
                   "row " + std::to_string(key) + " of " + name_ + " is damaged");
  }
  get_.reset();
  return found;
}

}  // namespace warren
