// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/item.hpp"

#include <array>
#include <bit>

#include "daemon/replication/item_wire.hpp"
#include "daemon/replication/layer_wire.hpp"

namespace warren::replication {

void write(mesh::PacketWriter& to, const LogId& log) {
  to.fixed(log.origin, 4);
  to.fixed(log.incarnation, 8);
}

std::optional<LogId> read_log_id(mesh::PacketReader& from) {
  const auto origin = from.fixed(4);
  const auto incarnation = from.fixed(8);
  if (!origin || !incarnation) return std::nullopt;
  return LogId{static_cast<std::uint32_t>(*origin), *incarnation};
}

void write(mesh::PacketWriter& to, const mesh::ByteRanges& numbers) {
  const auto ranges = numbers.ranges().first(std::min(numbers.ranges().size(), kRangesMax));
  to.number(ranges.size());
  std::uint64_t end = 0;
  for (const mesh::NumberRange& range : ranges) {
    to.number(range.first - end);
    to.number(range.end - range.first);
    end = range.end;
  }
}

std::optional<mesh::ByteRanges> read_ranges(mesh::PacketReader& from) {
  const auto count = from.number(kRangesMax);
  if (!count) return std::nullopt;
  mesh::ByteRanges numbers;
  std::uint64_t end = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto skipped = from.number(kItemNumberEnd);
    const auto length = skipped ? from.number(kItemNumberEnd) : std::nullopt;
    if (!length || *length == 0 || (i > 0 && *skipped == 0)) return std::nullopt;
    const std::uint64_t first = end + *skipped;
    end = first + *length;
    if (end > kItemNumberEnd) return std::nullopt;
    numbers.add({first, end});
  }
  return numbers;
}

mesh::ParcelClass class_of(ItemKind kind) {
  const bool first =
      kind == ItemKind::kCommand || kind == ItemKind::kReceipt || kind == ItemKind::kUrgentMessage;
  return first ? mesh::ParcelClass::kControl : mesh::ParcelClass::kMessage;
}

std::vector<std::uint8_t> encode(const Item& item) {
  std::vector<std::uint8_t> bytes;
  mesh::PacketWriter writer(bytes);
  writer.byte(static_cast<std::uint8_t>(item.kind));
  writer.number(item.to ? std::uint64_t{item.to->number} + 1 : 0);
  writer.number(item.name.size());
  writer.raw(item.name);
  writer.raw(item.bytes);
  return bytes;
}

std::optional<Item> read_item(std::span<const std::uint8_t> bytes) {
  mesh::PacketReader reader(bytes);
  const auto kind = reader.fixed(1);
  const auto to = kind ? reader.number(std::uint64_t{UINT32_MAX} + 1) : std::nullopt;
  const auto name_bytes = to ? reader.number(Item::kNameMax) : std::nullopt;
  const auto name = name_bytes ? reader.raw(*name_bytes) : std::nullopt;
  if (!name || *kind >= kItemKinds || reader.left() > Item::kBytesMax) return std::nullopt;
  const auto rest = *reader.raw(reader.left());
  Item item{static_cast<ItemKind>(*kind),
            std::nullopt,
            {name->begin(), name->end()},
            {rest.begin(), rest.end()}};
  if (*to > 0) item.to = MemberId{static_cast<std::uint32_t>(*to - 1)};
  return item;
}

std::vector<std::uint8_t> encode(const ItemParcel& parcel) {
  std::vector<std::uint8_t> bytes;
  mesh::PacketWriter writer(bytes);
  writer.byte(ItemParcel::kKind);
  write(writer, parcel.log);
  writer.number(parcel.number);
  writer.raw(encode(parcel.item));
  return bytes;
}

std::optional<ItemParcel> read_item_parcel(std::span<const std::uint8_t> bytes) {
  mesh::PacketReader reader(bytes);
  if (reader.fixed(1) != ItemParcel::kKind) return std::nullopt;
  const auto log = read_log_id(reader);
  const auto number = log ? reader.number(kItemNumberEnd - 1) : std::nullopt;
  if (!number) return std::nullopt;
  auto item = read_item(*reader.raw(reader.left()));
  if (!item) return std::nullopt;
  return ItemParcel{*log, static_cast<ItemNumber>(*number), std::move(*item)};
}

std::vector<std::uint8_t> encode(const VoidParcel& parcel) {
  std::vector<std::uint8_t> bytes;
  mesh::PacketWriter writer(bytes);
  writer.byte(VoidParcel::kKind);
  write(writer, parcel.log);
  write(writer, parcel.numbers);
  return bytes;
}

std::optional<VoidParcel> read_void_parcel(std::span<const std::uint8_t> bytes) {
  mesh::PacketReader reader(bytes);
  if (reader.fixed(1) != VoidParcel::kKind) return std::nullopt;
  const auto log = read_log_id(reader);
  auto numbers = log ? read_ranges(reader) : std::nullopt;
  if (!numbers || !reader.at_end()) return std::nullopt;
  return VoidParcel{*log, std::move(*numbers)};
}

// One receipt per log that is received from.
Item item_of(const ReceiptItem& receipt) {
  Item item;
  item.kind = ItemKind::kReceipt;
  mesh::PacketWriter name(item.name);
  write(name, receipt.log);
  mesh::PacketWriter writer(item.bytes);
  write(writer, receipt.log);
  write(writer, receipt.taken);
  return item;
}

std::optional<ReceiptItem> read_receipt(const Item& item) {
  if (item.kind != ItemKind::kReceipt) return std::nullopt;
  mesh::PacketReader reader(item.bytes);
  const auto log = read_log_id(reader);
  auto taken = log ? read_ranges(reader) : std::nullopt;
  if (!taken || !reader.at_end()) return std::nullopt;
  return ReceiptItem{*log, std::move(*taken)};
}

Item item_of(const LayerPoseItem& written) {
  Item item;
  item.kind = ItemKind::kLayerPose;
  mesh::PacketWriter name(item.name);
  name.byte(written.correction ? 1 : 0);
  write(name, written.layer);
  mesh::PacketWriter writer(item.bytes);
  writer.byte(written.correction ? 1 : 0);
  write(writer, written.layer);
  writer.fixed(written.pose.revision, 4);
  writer.fixed(written.pose.writer, 4);
  const auto& t = written.pose.pose.translation;
  const auto& q = written.pose.pose.rotation;
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    writer.fixed(std::bit_cast<std::uint64_t>(value), 8);
  }
  return item;
}

std::optional<LayerPoseItem> read_layer_pose(const Item& item) {
  if (item.kind != ItemKind::kLayerPose) return std::nullopt;
  mesh::PacketReader reader(item.bytes);
  const auto correction = reader.fixed(1);
  const auto layer = correction ? read_layer_id(reader) : std::nullopt;
  const auto revision = layer ? reader.fixed(4) : std::nullopt;
  const auto writer = revision ? reader.fixed(4) : std::nullopt;
  if (!writer || *correction > 1) return std::nullopt;
  std::array<double, 7> numbers{};
  for (double& number : numbers) {
    const auto bits = reader.fixed(8);
    if (!bits) return std::nullopt;
    number = std::bit_cast<double>(*bits);
  }
  if (!reader.at_end()) return std::nullopt;
  LayerPoseItem read{*layer, *correction == 1, {}};
  read.pose.revision = static_cast<std::uint32_t>(*revision);
  read.pose.writer = static_cast<std::uint32_t>(*writer);
  read.pose.pose.translation = {numbers[0], numbers[1], numbers[2]};
  read.pose.pose.rotation = Eigen::Quaterniond(numbers[6], numbers[3], numbers[4], numbers[5]);
  return read;
}

}  // namespace warren::replication
