// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/store_rows.hpp"

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "daemon/replication/item_wire.hpp"

namespace warren {
namespace {

using mesh::ByteRanges;
using mesh::PacketReader;
using mesh::PacketWriter;
using replication::LogId;

constexpr std::string_view kLogState = "log ";

// "log ORIGIN INCARNATION".
std::string state_name(const LogId& id) {
  return std::string(kLogState) + std::to_string(id.origin) + " " + std::to_string(id.incarnation);
}

std::optional<LogId> log_of(std::string_view name) {
  if (!name.starts_with(kLogState)) return std::nullopt;
  LogId id;
  const char* const end = name.data() + name.size();
  const auto origin = std::from_chars(name.data() + kLogState.size(), end, id.origin);
  if (origin.ec != std::errc{} || origin.ptr == end || *origin.ptr != ' ') return std::nullopt;
  const auto incarnation = std::from_chars(origin.ptr + 1, end, id.incarnation);
  const bool whole = incarnation.ec == std::errc{} && incarnation.ptr == end;
  return whole ? std::optional(id) : std::nullopt;
}

// How many; of each the numbers left out before it, and its length.
void write_all(PacketWriter& to, const ByteRanges& numbers) {
  to.number(numbers.ranges().size());
  std::uint64_t end = 0;
  for (const mesh::NumberRange& range : numbers.ranges()) {
    to.number(range.first - end);
    to.number(range.end - range.first);
    end = range.end;
  }
}

std::optional<ByteRanges> read_all(PacketReader& from) {
  constexpr std::uint64_t kEnd = replication::kItemNumberEnd;
  const auto count = from.number(kEnd);
  if (!count) return std::nullopt;
  ByteRanges numbers;
  std::uint64_t end = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto gap = from.number(kEnd - end);
    const auto length = gap ? from.number(kEnd - end - *gap) : std::nullopt;
    if (!length || *length == 0) return std::nullopt;
    numbers.add({end + *gap, end + *gap + *length});
    end += *gap + *length;
  }
  return numbers;
}

std::vector<std::uint8_t> state_of(const replication::StoredLog& log) {
  std::vector<std::uint8_t> bytes;
  PacketWriter writer(bytes);
  writer.byte(log.own ? 1 : 0);
  write_all(writer, log.voided);
  write_all(writer, log.seen);
  return bytes;
}

std::optional<replication::StoredLog> read_state(const LogId& id,
                                                 std::span<const std::uint8_t> bytes) {
  PacketReader reader(bytes);
  const auto own = reader.number(1);
  auto voided = own ? read_all(reader) : std::nullopt;
  auto seen = voided ? read_all(reader) : std::nullopt;
  if (!seen || !reader.at_end()) return std::nullopt;
  return replication::StoredLog{id, *own == 1, std::move(*voided), std::move(*seen), {}};
}

LogItemId row_id(const LogId& log, replication::ItemNumber number) {
  return {MemberId{log.origin}, log.incarnation, number};
}

void add_log(const replication::StoredLog& log, StoreBatch& rows) {
  rows.states[state_name(log.id)] = state_of(log);
  for (const auto& [number, item] : log.items) {
    if (item) {
      rows.items.push_back({row_id(log.id, number),
                            log.own,
                            static_cast<std::uint16_t>(item->kind),
                            item->to,
                            {},
                            replication::encode(*item)});
    } else {
      rows.erased_items.push_back(row_id(log.id, number));
    }
  }
}

}  // namespace

StoreBatch rows_of(const replication::StoreBatch& batch) {
  StoreBatch rows;
  for (const replication::StoredLayer& layer : batch.layers) {
    rows.layers.push_back({{layer.id, layer.resolution, layer.own, layer.pose, layer.holdings},
                           layer.forgotten,
                           layer.blocks});
  }
  for (const replication::StoredLog& log : batch.logs) add_log(log, rows);
  return rows;
}

StoredLogs logs_of(const std::vector<LogItem>& items,
                   const std::map<std::string, std::vector<std::uint8_t>>& states) {
  StoredLogs stored;
  std::map<LogId, replication::StoredLog> logs;
  for (const auto& [name, bytes] : states) {
    const auto id = log_of(name);
    if (!id) continue;
    auto log = read_state(*id, bytes);
    log ? (void)logs.emplace(*id, std::move(*log)) : (void)++stored.refused;
  }
  for (const LogItem& row : items) {
    const auto log = logs.find({row.id.origin.number, row.id.incarnation});
    auto item = replication::read_item(row.bytes);
    const bool fits = log != logs.end() && item && row.id.sequence < replication::kItemNumberEnd;
    if (fits) {
      log->second.items[static_cast<replication::ItemNumber>(row.id.sequence)] = std::move(item);
    } else {
      ++stored.refused;
    }
  }
  for (auto& [id, log] : logs) stored.logs.push_back(std::move(log));
  return stored;
}

}  // namespace warren
