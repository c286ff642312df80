// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "transport/wire/frame_types.hpp"
#include "transport/wire/frames.hpp"
#include "transport/wire/packet_reader.hpp"

namespace warren::mesh {
namespace {

std::vector<std::uint8_t> copy_of(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

// A length and as many bytes.
std::optional<std::vector<std::uint8_t>> read_bytes(PacketReader& reader, std::size_t max) {
  const auto length = reader.number(max);
  if (!length) return std::nullopt;
  const auto bytes = reader.raw(*length);
  if (!bytes) return std::nullopt;
  return copy_of(*bytes);
}

std::optional<Frame> read_hello(PacketReader& reader, bool wants_answer) {
  const auto member = reader.number(kMaxOf<std::uint32_t>);
  if (!member) return std::nullopt;
  return HelloFrame{{static_cast<std::uint32_t>(*member)}, wants_answer};
}

// The next range below `below`; at the first there is no gap.
std::optional<NumberRange> read_range_below(PacketReader& reader, std::uint64_t below, bool first) {
  const auto number = reader.number(kPacketNumberEnd - 1);
  const auto length_less_one = reader.number(kPacketNumberEnd - 1);
  if (!number || !length_less_one) return std::nullopt;
  if (!first && *number + 1 >= below) return std::nullopt;
  const std::uint64_t end = first ? *number + 1 : below - *number - 1;
  if (*length_less_one >= end) return std::nullopt;
  return NumberRange{end - *length_less_one - 1, end};
}

std::optional<Frame> read_ack(PacketReader& reader) {
  const auto count = reader.number(AckFrame::kRangesMax);
  if (!count || *count == 0) return std::nullopt;
  AckFrame frame;
  std::uint64_t below = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto range = read_range_below(reader, below, i == 0);
    if (!range) return std::nullopt;
    frame.ranges.push_back(*range);
    below = range->first;
  }
  const auto arrived_us = reader.fixed(4);
  const auto delay_us = reader.number(kAckDelayMaxUs);
  const auto pair_bytes = reader.fixed(4);
  const auto pair_us = reader.fixed(4);
  if (!arrived_us || !delay_us || !pair_bytes || !pair_us) return std::nullopt;
  frame.arrived_us = static_cast<std::uint32_t>(*arrived_us);
  frame.delay = Duration(*delay_us);
  frame.pair_bytes = static_cast<std::uint32_t>(*pair_bytes);
  frame.pair_us = static_cast<std::uint32_t>(*pair_us);
  return frame;
}

std::optional<Frame> read_ping(PacketReader& reader) {
  const auto padding = reader.number(kMaxOf<std::uint16_t>);
  if (!padding) return std::nullopt;
  const auto zeros = reader.raw(*padding);
  if (!zeros) return std::nullopt;
  if (std::any_of(zeros->begin(), zeros->end(), [](auto byte) { return byte != 0; })) {
    return std::nullopt;
  }
  return PingFrame{static_cast<std::uint16_t>(*padding)};
}

std::optional<Frame> read_urgent(PacketReader& reader) {
  const auto number = reader.number(kMaxOf<std::uint32_t>);
  if (!number) return std::nullopt;
  auto bytes = read_bytes(reader, UrgentFrame::kBytesMax);
  if (!bytes) return std::nullopt;
  return UrgentFrame{static_cast<std::uint32_t>(*number), std::move(*bytes)};
}

std::optional<Frame> read_telemetry(PacketReader& reader) {
  const auto key = reader.number(kMaxOf<std::uint16_t>);
  const auto version = reader.number(kMaxOf<std::uint32_t>);
  if (!key || !version) return std::nullopt;
  auto bytes = read_bytes(reader, TelemetryFrame::kBytesMax);
  if (!bytes) return std::nullopt;
  return TelemetryFrame{static_cast<std::uint16_t>(*key), static_cast<std::uint32_t>(*version),
                        std::move(*bytes)};
}

std::optional<ParcelKey> read_parcel_key(PacketReader& reader) {
  const auto stream = reader.fixed(8);
  const auto number = reader.number(kMaxOf<std::uint32_t>);
  if (!stream || !number) return std::nullopt;
  return ParcelKey{*stream, static_cast<std::uint32_t>(*number)};
}

std::optional<std::uint32_t> read_finished_before(PacketReader& reader, std::uint8_t short_age,
                                                  std::uint32_t number) {
  std::uint64_t age = short_age;
  if (short_age == kParcelAgeLong) {
    const auto more = reader.number(kMaxOf<std::uint32_t>);
    if (!more) return std::nullopt;
    age += *more;
  }
  if (age > number) return std::nullopt;
  return static_cast<std::uint32_t>(number - age);
}

// Offset, total and bytes, as the form says them. What another form says is not taken.
bool read_parcel_bytes(PacketReader& reader, ParcelForm form, ParcelFrame& frame) {
  std::uint64_t span = 0;
  if (form != ParcelForm::kWhole) {
    const auto field = reader.fixed(kParcelSpanBytes);
    if (!field) return false;
    span = *field;
  }
  frame.offset = static_cast<std::uint32_t>(span & ((1U << kParcelSpanBits) - 1));
  frame.total = static_cast<std::uint32_t>(span >> kParcelSpanBits);
  if (frame.total > ParcelFrame::kBytesMax || frame.offset > frame.total) return false;
  const std::size_t to_end = frame.total - frame.offset;
  std::uint64_t length = to_end;
  if (form != ParcelForm::kTail) {
    const auto field = reader.number(ParcelFrame::kBytesMax);
    if (!field) return false;
    length = *field;
  }
  const auto bytes = reader.raw(length);
  if (!bytes) return false;
  frame.bytes = copy_of(*bytes);
  switch (form) {
    case ParcelForm::kWhole:
      frame.total = static_cast<std::uint32_t>(length);
      return true;
    case ParcelForm::kTail:
      return frame.offset > 0;
    case ParcelForm::kPart:
      return length < to_end;
  }
  return false;
}

std::optional<Frame> read_parcel(PacketReader& reader, std::uint8_t type) {
  const auto form = static_cast<ParcelForm>(type >> kParcelFormShift & 3);
  const auto short_age = static_cast<std::uint8_t>(type & kParcelAgeLong);
  if (form > ParcelForm::kPart) return std::nullopt;
  ParcelFrame frame;
  frame.priority = static_cast<ParcelClass>(type >> kParcelClassShift & 1);
  const auto key = read_parcel_key(reader);
  if (!key) return std::nullopt;
  frame.parcel = *key;
  const auto finished_before = read_finished_before(reader, short_age, key->number);
  if (!finished_before) return std::nullopt;
  frame.finished_before = *finished_before;
  if (!read_parcel_bytes(reader, form, frame)) return std::nullopt;
  return frame;
}

std::optional<Frame> read_parcel_state(PacketReader& reader, bool finished) {
  const auto key = read_parcel_key(reader);
  if (!key) return std::nullopt;
  const auto count = reader.number(ParcelStateFrame::kRangesMax);
  if (!count) return std::nullopt;
  ParcelStateFrame frame{*key, finished, {}};
  std::uint64_t above = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto gap = reader.number(ParcelFrame::kBytesMax);
    const auto length_less_one = reader.number(ParcelFrame::kBytesMax);
    if (!gap || !length_less_one) return std::nullopt;
    const std::uint64_t first = i == 0 ? *gap : above + *gap + 1;
    const std::uint64_t end = first + *length_less_one + 1;
    if (end > ParcelFrame::kBytesMax) return std::nullopt;
    frame.have.push_back({first, end});
    above = end;
  }
  return frame;
}

std::optional<Frame> read_map(PacketReader& reader, MapClass priority) {
  return MapFrame{priority, copy_of(*reader.raw(reader.left()))};
}

std::optional<Frame> read_frame(PacketReader& reader) {
  const auto type = static_cast<std::uint8_t>(*reader.fixed(1));
  if (type >= static_cast<std::uint8_t>(FrameType::kParcel)) return read_parcel(reader, type);
  switch (static_cast<FrameType>(type)) {
    case FrameType::kHello:
      return read_hello(reader, false);
    case FrameType::kHelloWantsAnswer:
      return read_hello(reader, true);
    case FrameType::kAck:
      return read_ack(reader);
    case FrameType::kPing:
      return read_ping(reader);
    case FrameType::kUrgent:
      return read_urgent(reader);
    case FrameType::kTelemetry:
      return read_telemetry(reader);
    case FrameType::kParcelState:
      return read_parcel_state(reader, false);
    case FrameType::kParcelStateFinished:
      return read_parcel_state(reader, true);
    case FrameType::kMapFresh:
      return read_map(reader, MapClass::kFresh);
    case FrameType::kMapBacklog:
      return read_map(reader, MapClass::kBacklog);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<std::vector<Frame>> read_frames(std::span<const std::uint8_t> content) {
  std::vector<Frame> frames;
  PacketReader reader(content);
  while (!reader.at_end()) {
    auto frame = read_frame(reader);
    if (!frame) return std::nullopt;
    frames.push_back(std::move(*frame));
  }
  return frames;
}

}  // namespace warren::mesh
