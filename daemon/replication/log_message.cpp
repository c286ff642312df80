// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/log_message.hpp"

#include <utility>

#include "daemon/replication/item_wire.hpp"

namespace warren::replication {

std::vector<std::uint8_t> encode(const LogAnnouncement& announcement) {
  std::vector<std::uint8_t> bytes;
  mesh::PacketWriter writer(bytes);
  writer.byte(LogAnnouncement::kKind);
  write(writer, announcement.log);
  writer.byte(announcement.hops);
  writer.number(announcement.provider ? std::uint64_t{announcement.provider->number} + 1 : 0);
  write(writer, announcement.tellable);
  return bytes;
}

std::optional<LogAnnouncement> read_log_announcement(std::span<const std::uint8_t> bytes) {
  mesh::PacketReader reader(bytes);
  if (reader.fixed(1) != LogAnnouncement::kKind) return std::nullopt;
  const auto log = read_log_id(reader);
  const auto hops = log ? reader.fixed(1) : std::nullopt;
  const auto provider = hops ? reader.number(std::uint64_t{UINT32_MAX} + 1) : std::nullopt;
  auto tellable = provider ? read_ranges(reader) : std::nullopt;
  if (!tellable || !reader.at_end() || *hops > kNoWay) return std::nullopt;
  LogAnnouncement read{*log, static_cast<Hops>(*hops), std::nullopt, std::move(*tellable)};
  if (*provider > 0) read.provider = MemberId{static_cast<std::uint32_t>(*provider - 1)};
  return read;
}

void append(std::vector<std::uint8_t>& message, const LogWish& wish) {
  mesh::PacketWriter writer(message);
  writer.number(wish.slot);
  writer.number(wish.number << 1 | (wish.wanted ? 1U : 0U));
  if (wish.wanted) write(writer, wish.seen);
}

std::optional<std::vector<LogWish>> read_log_wishes(std::span<const std::uint8_t> bytes) {
  mesh::PacketReader reader(bytes);
  if (reader.fixed(1) != LogWish::kKind) return std::nullopt;
  std::vector<LogWish> wishes;
  while (!reader.at_end()) {
    const auto slot = reader.number(kSlotsMax - 1);
    const auto number = slot ? reader.number(UINT64_MAX >> 2) : std::nullopt;
    if (!number) return std::nullopt;
    LogWish wish{static_cast<Slot>(*slot), *number >> 1, (*number & 1) != 0, {}};
    if (wish.wanted) {
      auto seen = read_ranges(reader);
      if (!seen) return std::nullopt;
      wish.seen = std::move(*seen);
    }
    wishes.push_back(std::move(wish));
  }
  return wishes;
}

}  // namespace warren::replication
