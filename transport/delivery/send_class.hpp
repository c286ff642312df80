// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace warren::mesh {

// What a frame is to the scheduler; first things first.
enum class SendClass : std::uint8_t {
  kUrgent,
  kControl,  // acknowledgements, hello, pings, what is known of parcels
  kTelemetry,
  kControlParcel,
  kMessageParcel,
  kFresh,
  kBacklog,
};
inline constexpr std::size_t kSendClasses = 7;

}  // namespace warren::mesh
