// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/layer/claim.hpp"
#include "core/layer/layer_pose.hpp"
#include "transport/delivery/byte_ranges.hpp"
#include "transport/mesh_id.hpp"
#include "transport/wire/frames.hpp"

namespace warren::replication {

// The log of one node: its incarnation is drawn at random when it is begun, so that a node that
// lost its disk is never taken for its former self.
struct LogId {
  std::uint32_t origin = 0;
  std::uint64_t incarnation = 0;
  friend auto operator<=>(const LogId&, const LogId&) = default;
};
using ItemNumber = std::uint32_t;

enum class ItemKind : std::uint8_t {
  kMessage,    // of an application, to one or to all
  kLayerPose,  // LayerPoseItem
  kTrajectory,
  kStatus,
  kCommand,  // of the operator
  kReceipt,  // ReceiptItem
  kUrgentMessage,
};
inline constexpr std::size_t kItemKinds = 7;

struct Item {
  static constexpr std::size_t kBytesMax = 256 * 1024;
  static constexpr std::size_t kNameMax = 32;

  ItemKind kind = ItemKind::kMessage;
  std::optional<MemberId> to;      // none: everybody
  std::vector<std::uint8_t> name;  // of one name in a log only the latest counts; empty: all count
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const Item&, const Item&) = default;
};

// Commands, receipts and urgent messages go before the rest.
mesh::ParcelClass class_of(ItemKind kind);
// Whether it is for an application, which takes it when it likes.
inline bool is_message(const Item& item) {
  return item.kind == ItemKind::kMessage || item.kind == ItemKind::kUrgentMessage;
}

// What a parcel holds. 0x41: log (12 bytes), number (LEB128), item: kind, addressee + 1 (LEB128, 0
// for all), name behind its length, bytes to the end.
struct ItemParcel {
  static constexpr std::uint8_t kKind = 0x41;
  LogId log;
  ItemNumber number = 0;
  Item item;
};
// 0x42: log, ranges: these items count no more.
struct VoidParcel {
  static constexpr std::uint8_t kKind = 0x42;
  LogId log;
  mesh::ByteRanges numbers;
};
std::vector<std::uint8_t> encode(const ItemParcel& parcel);
std::vector<std::uint8_t> encode(const VoidParcel& parcel);
std::optional<ItemParcel> read_item_parcel(std::span<const std::uint8_t> bytes);
std::optional<VoidParcel> read_void_parcel(std::span<const std::uint8_t> bytes);

// Items as a store keeps them, beside log and number.
std::vector<std::uint8_t> encode(const Item& item);
std::optional<Item> read_item(std::span<const std::uint8_t> bytes);

// Everything addressed to the writer of this, out of these items of a log, has been taken: stored,
// and, if it is a message, fetched by an application.
struct ReceiptItem {
  LogId log;
  mesh::ByteRanges taken;
};
Item item_of(const ReceiptItem& receipt);
std::optional<ReceiptItem> read_receipt(const Item& item);

// Where a layer lies. Corrections are the operator's, and believed of commands alone.
struct LayerPoseItem {
  LayerId layer;
  bool correction = false;
  WrittenPose pose;
};
Item item_of(const LayerPoseItem& pose);
std::optional<LayerPoseItem> read_layer_pose(const Item& item);

inline constexpr std::size_t kRangesMax = 32;  // in one message; of more, the lowest

}  // namespace warren::replication
