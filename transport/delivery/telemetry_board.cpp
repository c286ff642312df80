// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/telemetry_board.hpp"

namespace warren::mesh {

bool TelemetryBoard::set(std::uint16_t key, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > TelemetryFrame::kBytesMax) return false;
  if (values_.size() == kKeysMax && !values_.contains(key)) return false;
  Value& value = values_[key];
  ++value.version;
  value.bytes.assign(bytes.begin(), bytes.end());
  return true;
}

}  // namespace warren::mesh
