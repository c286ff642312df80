// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/message.hpp"

#include <utility>

#include "daemon/control/message_key.hpp"
#include "transport/wire/packet_reader.hpp"
#include "transport/wire/packet_writer.hpp"

namespace warren {
namespace {

using replication::Item;
using replication::ItemKind;

// So that no item of another kind has the same name.
constexpr std::uint8_t kMessageMark = 'm';
constexpr std::size_t kNameHeadBytes = 5;
constexpr std::uint32_t kEverybody = UINT32_MAX;

}  // namespace

Item item_of(const Message& message) {
  Item item;
  item.kind = message.urgent ? ItemKind::kUrgentMessage : ItemKind::kMessage;
  item.to = message.to;
  if (!message.key.empty()) {
    mesh::PacketWriter name(item.name);
    name.byte(kMessageMark);
    name.fixed(message.to ? message.to->number : kEverybody, 4);
    for (const char c : message.key) name.byte(static_cast<std::uint8_t>(c));
  }
  mesh::PacketWriter writer(item.bytes);
  writer.byte(Message::kKind);
  writer.fixed(static_cast<std::uint64_t>(message.time_us), 8);
  writer.raw(message.bytes);
  return item;
}

std::optional<Message> read_message(const Item& item) {
  if (!replication::is_message(item)) return std::nullopt;
  mesh::PacketReader reader(item.bytes);
  if (reader.fixed(1) != Message::kKind) return std::nullopt;
  const auto time = reader.fixed(8);
  if (!time || reader.left() > Message::kBytesMax) return std::nullopt;
  const auto bytes = *reader.raw(reader.left());
  Message message;
  message.to = item.to;
  message.urgent = item.kind == ItemKind::kUrgentMessage;
  message.time_us = static_cast<std::int64_t>(*time);
  message.bytes.assign(bytes.begin(), bytes.end());
  if (item.name.empty()) return message;
  mesh::PacketReader name(item.name);
  const bool is_ours = name.fixed(1) == kMessageMark &&
                       name.fixed(4) == (item.to ? item.to->number : kEverybody) && !name.at_end();
  if (!is_ours) return std::nullopt;
  message.key.assign(item.name.begin() + kNameHeadBytes, item.name.end());
  return is_message_key(message.key) ? std::optional(std::move(message)) : std::nullopt;
}

}  // namespace warren
