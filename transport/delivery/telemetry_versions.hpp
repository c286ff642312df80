// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

namespace warren::mesh {

// The latest version of each key that came in one boot of the peer. Versions wrap around.
class TelemetryVersions {
 public:
  static constexpr std::size_t kKeysMax = 640;
  enum class Verdict : std::uint8_t { kNew, kStale, kTooManyKeys };

  Verdict take(std::uint16_t key, std::uint32_t version);

 private:
  std::map<std::uint16_t, std::uint32_t> latest_;
};

}  // namespace warren::mesh
