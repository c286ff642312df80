// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cassert>
#include <span>

#include "transport/wire/frame_types.hpp"
#include "transport/wire/frames.hpp"
#include "transport/wire/packet_writer.hpp"

namespace warren::mesh {
namespace {

// Takes what PacketWriter takes, and only counts it.
class ByteCounter {
 public:
  std::size_t bytes() const { return bytes_; }
  void byte(std::uint8_t) { ++bytes_; }
  void fixed(std::uint64_t, int bytes) { bytes_ += static_cast<std::size_t>(bytes); }
  void number(std::uint64_t value) { bytes_ += number_bytes(value); }
  void raw(std::span<const std::uint8_t> bytes) { bytes_ += bytes.size(); }

 private:
  std::size_t bytes_ = 0;
};

template <typename Writer>
void write_type(Writer& writer, FrameType type) {
  writer.byte(static_cast<std::uint8_t>(type));
}

template <typename Writer>
void write(Writer& writer, const HelloFrame& frame) {
  write_type(writer, frame.wants_answer ? FrameType::kHelloWantsAnswer : FrameType::kHello);
  writer.number(frame.member.number);
}

template <typename Writer>
void write(Writer& writer, const AckFrame& frame) {
  assert(!frame.ranges.empty() && frame.ranges.size() <= AckFrame::kRangesMax);
  assert(frame.delay.count() >= 0);
  assert(static_cast<std::uint64_t>(frame.delay.count()) <= kAckDelayMaxUs);
  write_type(writer, FrameType::kAck);
  writer.number(frame.ranges.size());
  std::uint64_t below = 0;
  for (const NumberRange& range : frame.ranges) {
    assert(range.first < range.end && range.end <= kPacketNumberEnd);
    if (&range == &frame.ranges.front()) {
      writer.number(range.end - 1);
    } else {
      assert(range.end < below);
      writer.number(below - range.end - 1);
    }
    writer.number(range.end - range.first - 1);
    below = range.first;
  }
  writer.fixed(frame.arrived_us, 4);
  writer.number(static_cast<std::uint64_t>(frame.delay.count()));
  writer.fixed(frame.pair_bytes, 4);
  writer.fixed(frame.pair_us, 4);
}

template <typename Writer>
void write(Writer& writer, const PingFrame& frame) {
  static constexpr std::array<std::uint8_t, 0xFFFF> kZeros{};
  write_type(writer, FrameType::kPing);
  writer.number(frame.padding);
  writer.raw(std::span(kZeros).first(frame.padding));
}

template <typename Writer>
void write(Writer& writer, const UrgentFrame& frame) {
  assert(frame.bytes.size() <= UrgentFrame::kBytesMax);
  write_type(writer, FrameType::kUrgent);
  writer.number(frame.number);
  writer.number(frame.bytes.size());
  writer.raw(frame.bytes);
}

template <typename Writer>
void write(Writer& writer, const TelemetryFrame& frame) {
  assert(frame.bytes.size() <= TelemetryFrame::kBytesMax);
  write_type(writer, FrameType::kTelemetry);
  writer.number(frame.key);
  writer.number(frame.version);
  writer.number(frame.bytes.size());
  writer.raw(frame.bytes);
}

ParcelForm form_of(const ParcelFrame& frame) {
  if (frame.bytes.size() == frame.total) return ParcelForm::kWhole;
  return frame.offset + frame.bytes.size() == frame.total ? ParcelForm::kTail : ParcelForm::kPart;
}

template <typename Writer>
void write(Writer& writer, const ParcelFrame& frame) {
  assert(frame.total <= ParcelFrame::kBytesMax && frame.offset <= frame.total);
  assert(frame.bytes.size() <= frame.total - frame.offset);
  assert(frame.finished_before <= frame.parcel.number);
  const ParcelForm form = form_of(frame);
  const std::uint32_t age = frame.parcel.number - frame.finished_before;
  const auto short_age = static_cast<unsigned>(std::min<std::uint32_t>(age, kParcelAgeLong));
  writer.byte(static_cast<std::uint8_t>(static_cast<unsigned>(FrameType::kParcel) |
                                        static_cast<unsigned>(frame.priority) << kParcelClassShift |
                                        static_cast<unsigned>(form) << kParcelFormShift |
                                        short_age));
  writer.fixed(frame.parcel.stream, 8);
  writer.number(frame.parcel.number);
  if (short_age == kParcelAgeLong) writer.number(age - kParcelAgeLong);
  if (form != ParcelForm::kWhole) {
    writer.fixed(frame.offset | std::uint64_t{frame.total} << kParcelSpanBits,
                 static_cast<int>(kParcelSpanBytes));
  }
  if (form != ParcelForm::kTail) writer.number(frame.bytes.size());
  writer.raw(frame.bytes);
}

template <typename Writer>
void write(Writer& writer, const ParcelStateFrame& frame) {
  assert(frame.have.size() <= ParcelStateFrame::kRangesMax);
  write_type(writer, frame.finished ? FrameType::kParcelStateFinished : FrameType::kParcelState);
  writer.fixed(frame.parcel.stream, 8);
  writer.number(frame.parcel.number);
  writer.number(frame.have.size());
  std::uint64_t above = 0;
  for (const NumberRange& range : frame.have) {
    assert(range.first < range.end && range.end <= ParcelFrame::kBytesMax);
    if (&range == &frame.have.front()) {
      writer.number(range.first);
    } else {
      assert(range.first > above);
      writer.number(range.first - above - 1);
    }
    writer.number(range.end - range.first - 1);
    above = range.end;
  }
}

template <typename Writer>
void write(Writer& writer, const MapFrame& frame) {
  const bool fresh = frame.priority == MapClass::kFresh;
  write_type(writer, fresh ? FrameType::kMapFresh : FrameType::kMapBacklog);
  writer.raw(frame.bytes);
}

}  // namespace

std::size_t encoded_bytes(const Frame& frame) {
  ByteCounter counter;
  std::visit([&](const auto& kind) { write(counter, kind); }, frame);
  return counter.bytes();
}

void append(std::vector<std::uint8_t>& content, const Frame& frame) {
  PacketWriter writer(content);
  std::visit([&](const auto& kind) { write(writer, kind); }, frame);
}

}  // namespace warren::mesh
