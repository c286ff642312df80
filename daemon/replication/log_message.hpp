// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/replication/announcement.hpp"
#include "daemon/replication/item.hpp"
#include "daemon/replication/map_message.hpp"

namespace warren::replication {

// What a node tells everybody of a log that it holds, as a telemetry value: 0x12, log (12 bytes),
// hops (1), provider + 1 (LEB128, 0: none), ranges of what it can tell.
struct LogAnnouncement {
  static constexpr std::uint8_t kKind = 0x12;
  LogId log;
  Hops hops = kNoWay;
  std::optional<MemberId> provider;
  mesh::ByteRanges tellable;
  friend bool operator==(const LogAnnouncement&, const LogAnnouncement&) = default;
};

// What a member wants of a log from the receiver, until it says otherwise; a map packet of one or
// several: 0x25; then of each slot of the receiver, number * 2 + wanted, ranges that it has seen.
struct LogWish {
  static constexpr std::uint8_t kKind = 0x25;
  Slot slot = 0;
  std::uint64_t number = 0;
  bool wanted = false;
  mesh::ByteRanges seen;
  friend bool operator==(const LogWish&, const LogWish&) = default;
};

std::vector<std::uint8_t> encode(const LogAnnouncement& announcement);
std::optional<LogAnnouncement> read_log_announcement(std::span<const std::uint8_t> bytes);
// Appends to a message that begins with LogWish::kKind.
void append(std::vector<std::uint8_t>& message, const LogWish& wish);
// Nothing if the message is malformed, or of another kind.
std::optional<std::vector<LogWish>> read_log_wishes(std::span<const std::uint8_t> bytes);

}  // namespace warren::replication
