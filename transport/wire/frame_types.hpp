// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "transport/wire/envelope.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

// First byte of a frame. Zero is none: content that was never written is not read as frames.
enum class FrameType : std::uint8_t {
  kHello = 1,
  kHelloWantsAnswer,
  kAck,
  kPing,
  kUrgent,
  kTelemetry,
  kParcelState,
  kParcelStateFinished,
  kMapFresh,
  kMapBacklog,
  kParcel = 0x80,  // and all above: class, form and age in the lower bits
};

// How much of its parcel a parcel frame carries; what follows from it is not said.
enum class ParcelForm : std::uint8_t { kWhole, kTail, kPart };

constexpr int kParcelClassShift = 6;
constexpr int kParcelFormShift = 4;
// Age: number - finished_before. This and all above are a number after the parcel's.
constexpr std::uint8_t kParcelAgeLong = 15;
// Offset and total of a parcel, 20 bits each.
constexpr int kParcelSpanBits = 20;
constexpr std::size_t kParcelSpanBytes = 5;
static_assert(ParcelFrame::kBytesMax < 1U << kParcelSpanBits);

// Microseconds: an hour and more.
constexpr std::uint64_t kAckDelayMaxUs = 0xFFFFFFFF;

}  // namespace warren::mesh
