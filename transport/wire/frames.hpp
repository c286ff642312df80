// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "transport/mesh_id.hpp"
#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Numbers from `first` up to, not including, `end`.
struct NumberRange {
  std::uint64_t first = 0;
  std::uint64_t end = 0;
  friend bool operator==(const NumberRange&, const NumberRange&) = default;
};

// Who speaks: in each pair packet until the other is known to know it.
struct HelloFrame {
  MemberId member;
  bool wants_answer = false;  // the sender has not yet heard a pair packet of this boot
  friend bool operator==(const HelloFrame&, const HelloFrame&) = default;
};

// What arrived. Precondition of encoding: at least one range; none empty, no two touching, highest
// first; the delay below 2^32 microseconds.
struct AckFrame {
  static constexpr std::size_t kRangesMax = 32;
  std::vector<NumberRange> ranges;
  // By the receiver's clock, modulo 2^32 microseconds: when the packet ranges[0].end - 1 arrived.
  std::uint32_t arrived_us = 0;
  // From that arrival to the sending of this frame.
  Duration delay{};
  // Sums over all pairs of consecutive numbers that both arrived so far, modulo 2^32: the IP bytes
  // of the second, and the microseconds from the first's arrival to the second's (signed: they may
  // come in the other order). What the link carries while it has no rest, whatever is lost beside.
  static constexpr Duration kPairGapMax = std::chrono::seconds{1};  // further apart are none
  std::uint32_t pair_bytes = 0;
  std::uint32_t pair_us = 0;
  friend bool operator==(const AckFrame&, const AckFrame&) = default;
};

// Carries nothing; asks for an acknowledgement. Padded to find out whether large packets pass.
struct PingFrame {
  std::uint16_t padding = 0;  // bytes
  friend bool operator==(const PingFrame&, const PingFrame&) = default;
};

struct UrgentFrame {
  static constexpr std::size_t kBytesMax = 64;
  static constexpr std::size_t kOverheadMax = 7;
  std::uint32_t number = 0;  // of the sender's boot
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const UrgentFrame&, const UrgentFrame&) = default;
};

struct TelemetryFrame {
  static constexpr std::size_t kBytesMax = 1000;
  static constexpr std::size_t kOverheadMax = 11;
  std::uint16_t key = 0;
  std::uint32_t version = 0;  // of this key, of the sender's boot
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const TelemetryFrame&, const TelemetryFrame&) = default;
};

// Parcels to one member have rising numbers in a stream that outlives restarts: 64 random bits,
// drawn anew only if the sender's store is lost. A restart of the sender leaves a gap.
struct ParcelKey {
  std::uint64_t stream = 0;
  std::uint32_t number = 0;
  friend auto operator<=>(const ParcelKey&, const ParcelKey&) = default;
};

enum class ParcelClass : std::uint8_t { kControl, kMessage };

// A part of a parcel, or all of it; without bytes it asks what the receiver has. Precondition of
// encoding: it lies within the total, and finished_before is not above the parcel's own number.
struct ParcelFrame {
  static constexpr std::uint32_t kBytesMax = 1'000'000;
  // What a frame takes beside its bytes, at most; 11 to 18 as long as numbers are small.
  static constexpr std::size_t kOverheadMax = 27;
  ParcelKey parcel;
  ParcelClass priority = ParcelClass::kMessage;
  // All parcels of the stream before this number are finished on the sender's side: the receiver
  // may forget them.
  std::uint32_t finished_before = 0;
  std::uint32_t total = 0;
  std::uint32_t offset = 0;
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const ParcelFrame&, const ParcelFrame&) = default;
};

// From the receiver of a parcel: what it has of it. Finished: it has been handed over.
struct ParcelStateFrame {
  static constexpr std::size_t kRangesMax = 32;
  ParcelKey parcel;
  bool finished = false;
  std::vector<NumberRange> have;  // bytes, in order, not touching
  friend bool operator==(const ParcelStateFrame&, const ParcelStateFrame&) = default;
};

enum class MapClass : std::uint8_t { kFresh, kBacklog };

// One packet of the layer above. Always the last frame of a packet: its bytes go to the end.
struct MapFrame {
  static constexpr std::size_t kOverhead = 1;
  MapClass priority = MapClass::kBacklog;
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const MapFrame&, const MapFrame&) = default;
};

using Frame = std::variant<HelloFrame, AckFrame, PingFrame, UrgentFrame, TelemetryFrame,
                           ParcelFrame, ParcelStateFrame, MapFrame>;

// Exact size of the encoded frame.
std::size_t encoded_bytes(const Frame& frame);
void append(std::vector<std::uint8_t>& content, const Frame& frame);
// All frames of a packet's content; nothing if it is malformed or of an unknown kind. Bounded in
// time and memory by the content's size.
std::optional<std::vector<Frame>> read_frames(std::span<const std::uint8_t> content);

}  // namespace warren::mesh
