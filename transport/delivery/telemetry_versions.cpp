// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/telemetry_versions.hpp"

namespace warren::mesh {

TelemetryVersions::Verdict TelemetryVersions::take(std::uint16_t key, std::uint32_t version) {
  const auto known = latest_.find(key);
  if (known == latest_.end()) {
    if (latest_.size() == kKeysMax) return Verdict::kTooManyKeys;
    latest_.emplace(key, version);
    return Verdict::kNew;
  }
  const std::uint32_t ahead = version - known->second;
  if (ahead == 0 || ahead >= 0x8000'0000U) return Verdict::kStale;
  known->second = version;
  return Verdict::kNew;
}

}  // namespace warren::mesh
