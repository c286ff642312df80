// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace warren {

// The transport never reads a clock: whoever drives it says what time it is. The epoch is the
// caller's; time does not go back.
using Duration = std::chrono::microseconds;
using MeshTime = std::chrono::time_point<std::chrono::steady_clock, Duration>;

inline constexpr MeshTime kNever = MeshTime::max();

}  // namespace warren
