// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "daemon/store/head_bytes.hpp"
#include "daemon/store/row_table.hpp"
#include "daemon/store/store_result.hpp"

namespace warren {

inline constexpr std::size_t kNamedMax = 4096;  // counters and states together
inline constexpr std::size_t kStoredNameBytesMax = 256;

// Counters and opaque states by name.
class NamedTable {
 public:
  explicit NamedTable(Database& database) : rows_(database, "named") {}

  // The names, read anew.
  void load();
  BatchResult judge(const StoreBatch& batch) const;
  // Precondition: judged as kStored.
  void write(const StoreBatch& batch);

  std::map<std::string, std::uint64_t> counters();
  std::map<std::string, Bytes> states();

 private:
  using Name = std::pair<bool, std::string>;  // whether it is a counter

  void put(const Name& name, Bytes content);
  void erase(const Name& name);

  RowTable rows_;
  std::map<Name, std::int64_t> entries_;
  std::int64_t next_row_ = 0;
};

}  // namespace warren
