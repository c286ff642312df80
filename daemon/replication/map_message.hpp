// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/layer/digest.hpp"
#include "core/layer/holdings.hpp"
#include "daemon/replication/layer_wire.hpp"

namespace warren::replication {

// A node numbers the layers it holds in the order in which it came to hold them; its announcements
// say which is which. In one boot a number never means another layer.
using Slot = std::uint16_t;
inline constexpr Slot kSlotsMax = 256;

inline constexpr RegionOrdinal kRegionEnd = region_of(kOrdinalEnd);  // behind the last

// What one map packet of the mesh carries; its first byte is kind and version.

// 0x21: slot (LEB128) of the sender, then a diff packet.
struct DiffMessage {
  static constexpr std::uint8_t kKind = 0x21;
  Slot slot = 0;
  std::span<const std::uint8_t> packet;
};
inline constexpr std::size_t kDiffOverhead = 3;  // kind and slot

// What a member wants of one layer from the receiver, until it says otherwise.
struct Wish {
  Slot slot = 0;             // of the receiver
  std::uint64_t number = 0;  // counts up with every wish for this layer
  bool wanted = false;       // or no more, and what follows is left out
  bool lost = false;         // what the receiver took for delivered was not: believe these holdings
  Holdings holdings;         // of the sender, at this moment
  KeySet keys;
  friend bool operator==(const Wish&, const Wish&) = default;
};
// 0x22: wishes to the end: slot, number * 4 + lost * 2 + wanted, holdings, keys.
struct WishMessage {
  static constexpr std::uint8_t kKind = 0x22;
  std::vector<Wish> wishes;
};

// 0x23: which regions differ? Slot of the receiver; revision; region from which on.
struct DigestQuestion {
  static constexpr std::uint8_t kKind = 0x23;
  Slot slot = 0;
  Revision revision;
  RegionOrdinal first = 0;
};
// 0x24: slot of the sender; revision; first region; end (0: of all); of the regions between: how
// many after the one before it, the first 8 bytes of its hash.
struct DigestAnswer {
  static constexpr std::uint8_t kKind = 0x24;
  struct Region {
    RegionOrdinal region = 0;
    std::uint64_t hash = 0;
  };
  static constexpr std::size_t kRegionBytesMax = 13;
  static constexpr std::size_t kOverheadMax = 20;
  Slot slot = 0;
  Revision revision;
  RegionOrdinal first = 0;
  RegionOrdinal end = 0;
  std::vector<Region> regions;
};

using MapMessage = std::variant<DiffMessage, WishMessage, DigestQuestion, DigestAnswer>;

std::vector<std::uint8_t> encode(const DiffMessage& message);
// Appends to a message that begins with WishMessage::kKind.
void append(std::vector<std::uint8_t>& message, const Wish& wish);
std::vector<std::uint8_t> encode(const DigestQuestion& question);
std::vector<std::uint8_t> encode(const DigestAnswer& answer);
// Nothing if it is malformed or of an unknown kind. A DiffMessage refers to the bytes.
std::optional<MapMessage> read_map_message(std::span<const std::uint8_t> bytes);

// The first eight bytes.
std::uint64_t prefix_of(const Hash& hash);

}  // namespace warren::replication
