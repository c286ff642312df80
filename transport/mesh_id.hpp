// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace warren {

// A member of the fleet, the same through all its restarts.
struct MemberId {
  std::uint32_t number = 0;
  friend auto operator<=>(const MemberId&, const MemberId&) = default;
};

// One life of a member's process: 64 random bits drawn at its start. All keys are derived from it,
// so no restart can use a nonce again, whatever was stored.
struct BootId {
  std::uint64_t bits = 0;
  friend auto operator<=>(const BootId&, const BootId&) = default;
};

}  // namespace warren
