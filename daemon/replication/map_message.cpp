// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/map_message.hpp"

namespace warren::replication {
namespace {

std::optional<Slot> read_slot(mesh::PacketReader& reader) {
  const auto slot = reader.number(kSlotsMax - 1);
  return slot ? std::optional(static_cast<Slot>(*slot)) : std::nullopt;
}

std::optional<Revision> read_revision(mesh::PacketReader& reader) {
  const auto number = reader.number(UINT32_MAX);
  return number ? std::optional(Revision{static_cast<std::uint32_t>(*number)}) : std::nullopt;
}

std::optional<Wish> read_wish(mesh::PacketReader& reader) {
  const auto slot = read_slot(reader);
  const auto number = slot ? reader.number(UINT64_MAX >> 2) : std::nullopt;
  if (!number) return std::nullopt;
  Wish wish{*slot, *number >> 2, (*number & 1) != 0, (*number & 2) != 0, Holdings(), KeySet()};
  if (!wish.wanted) return wish.lost ? std::nullopt : std::optional(wish);
  auto holdings = read_holdings(reader);
  auto keys = holdings ? read_key_set(reader) : std::nullopt;
  if (!keys) return std::nullopt;
  wish.holdings = std::move(*holdings);
  wish.keys = std::move(*keys);
  return wish;
}

std::optional<MapMessage> read_wishes(mesh::PacketReader& reader) {
  WishMessage message;
  while (!reader.at_end()) {
    auto wish = read_wish(reader);
    if (!wish) return std::nullopt;
    message.wishes.push_back(std::move(*wish));
  }
  return message;
}

std::optional<MapMessage> read_question(mesh::PacketReader& reader) {
  const auto slot = read_slot(reader);
  const auto revision = slot ? read_revision(reader) : std::nullopt;
  const auto first = revision ? reader.number(kRegionEnd - 1) : std::nullopt;
  if (!first || !reader.at_end()) return std::nullopt;
  return DigestQuestion{*slot, *revision, *first};
}

std::optional<MapMessage> read_answer(mesh::PacketReader& reader) {
  const auto slot = read_slot(reader);
  const auto revision = slot ? read_revision(reader) : std::nullopt;
  const auto first = revision ? reader.number(kRegionEnd - 1) : std::nullopt;
  const auto end = first ? reader.number(kRegionEnd - 1) : std::nullopt;
  if (!end) return std::nullopt;
  DigestAnswer answer{*slot, *revision, *first, *end == 0 ? kRegionEnd : *end, {}};
  RegionOrdinal next = answer.first;
  while (!reader.at_end()) {
    const auto skipped = reader.number(kRegionEnd);
    const auto hash = skipped ? reader.fixed(8) : std::nullopt;
    if (!hash || next + *skipped >= answer.end) return std::nullopt;
    answer.regions.push_back({next + *skipped, *hash});
    next += *skipped + 1;
  }
  return answer.first < answer.end ? std::optional<MapMessage>(answer) : std::nullopt;
}

}  // namespace

std::vector<std::uint8_t> encode(const DiffMessage& message) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(message.packet.size() + 4);
  mesh::PacketWriter writer(bytes);
  writer.byte(DiffMessage::kKind);
  writer.number(message.slot);
  writer.raw(message.packet);
  return bytes;
}

void append(std::vector<std::uint8_t>& message, const Wish& wish) {
  mesh::PacketWriter writer(message);
  writer.number(wish.slot);
  writer.number(wish.number << 2 | (wish.lost ? 2U : 0U) | (wish.wanted ? 1U : 0U));
  if (!wish.wanted) return;
  write(writer, wish.holdings);
  write(writer, wish.keys);
}

std::vector<std::uint8_t> encode(const DigestQuestion& question) {
  std::vector<std::uint8_t> bytes;
  mesh::PacketWriter writer(bytes);
  writer.byte(DigestQuestion::kKind);
  writer.number(question.slot);
  writer.number(question.revision.number);
  writer.number(question.first);
  return bytes;
}

std::vector<std::uint8_t> encode(const DigestAnswer& answer) {
  std::vector<std::uint8_t> bytes;
  mesh::PacketWriter writer(bytes);
  writer.byte(DigestAnswer::kKind);
  writer.number(answer.slot);
  writer.number(answer.revision.number);
  writer.number(answer.first);
  writer.number(answer.end == kRegionEnd ? 0 : answer.end);
  RegionOrdinal next = answer.first;
  for (const DigestAnswer::Region& region : answer.regions) {
    writer.number(region.region - next);
    writer.fixed(region.hash, 8);
    next = region.region + 1;
  }
  return bytes;
}

std::optional<MapMessage> read_map_message(std::span<const std::uint8_t> bytes) {
  mesh::PacketReader reader(bytes);
  const auto kind = reader.fixed(1);
  if (!kind) return std::nullopt;
  if (*kind == WishMessage::kKind) return read_wishes(reader);
  if (*kind == DigestQuestion::kKind) return read_question(reader);
  if (*kind == DigestAnswer::kKind) return read_answer(reader);
  if (*kind != DiffMessage::kKind) return std::nullopt;
  const auto slot = read_slot(reader);
  if (!slot) return std::nullopt;
  return DiffMessage{*slot, *reader.raw(reader.left())};
}

std::uint64_t prefix_of(const Hash& hash) {
  std::uint64_t prefix = 0;
  for (std::size_t i = 0; i < 8; ++i) prefix |= std::uint64_t{hash[i]} << 8 * i;
  return prefix;
}

}  // namespace warren::replication
