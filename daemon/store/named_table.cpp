// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/named_table.hpp"

#include "core/exchange/byte_fields.hpp"

namespace warren {

void NamedTable::load() {
  entries_.clear();
  next_row_ = 0;
  rows_.for_each(0, kAllRows, [&](std::int64_t row, ByteView bytes) {
    const auto named = decode_named(bytes);
    next_row_ = row + 1;
    return named && entries_.try_emplace({named->is_counter, named->name}, row).second;
  });
}

BatchResult NamedTable::judge(const StoreBatch& batch) const {
  std::size_t added = 0;
  bool sound = true;
  const auto look_at = [&](bool is_counter, const std::string& name) {
    added += entries_.contains({is_counter, name}) ? 0 : 1;
    sound = sound && name.size() <= kStoredNameBytesMax;
  };
  for (const auto& [name, value] : batch.counters) look_at(true, name);
  for (const auto& [name, state] : batch.states) look_at(false, name);
  return sound && entries_.size() + added <= kNamedMax ? BatchResult::kStored
                                                       : BatchResult::kUnsound;
}

void NamedTable::write(const StoreBatch& batch) {
  for (const auto& [name, value] : batch.counters) {
    ByteWriter writer;
    writer.add(value);
    put({true, name}, writer.take());
  }
  for (const auto& [name, state] : batch.states) {
    state.empty() ? erase({false, name}) : put({false, name}, state);
  }
}

void NamedTable::put(const Name& name, Bytes content) {
  const auto [entry, added] = entries_.try_emplace(name, next_row_);
  if (added) ++next_row_;
  rows_.put(entry->second, encode_named({name.second, name.first, std::move(content)}));
}

void NamedTable::erase(const Name& name) {
  const auto found = entries_.find(name);
  if (found == entries_.end()) return;
  rows_.erase(found->second, found->second + 1);
  entries_.erase(found);
}

std::map<std::string, std::uint64_t> NamedTable::counters() {
  std::map<std::string, std::uint64_t> counters;
  rows_.for_each(0, kAllRows, [&](std::int64_t, ByteView bytes) {
    const auto named = decode_named(bytes);
    if (named && named->is_counter) {
      counters[named->name] = ByteReader(named->content).number<std::uint64_t>();
    }
    return named.has_value();
  });
  return counters;
}

std::map<std::string, Bytes> NamedTable::states() {
  std::map<std::string, Bytes> states;
  rows_.for_each(0, kAllRows, [&](std::int64_t, ByteView bytes) {
    auto named = decode_named(bytes);
    if (named && !named->is_counter) states[named->name] = std::move(named->content);
    return named.has_value();
  });
  return states;
}

}  // namespace warren
