// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace warren {

// Lets a few lines per minute through, so that a client in a loop cannot flood the log. What it
// holds back is counted elsewhere: in status.
class LogThrottle {
 public:
  static constexpr std::uint32_t kLinesPerMinute = 20;
  using Time = std::chrono::steady_clock::time_point;

  explicit LogThrottle(std::uint32_t lines_per_minute = kLinesPerMinute)
      : lines_per_minute_(lines_per_minute) {}

  bool allows(Time now) {
    if (now - minute_began_ >= std::chrono::minutes(1)) {
      minute_began_ = now;
      lines_ = 0;
    }
    return lines_++ < lines_per_minute_;
  }

 private:
  std::uint32_t lines_per_minute_;
  Time minute_began_{};
  std::uint32_t lines_ = 0;
};

}  // namespace warren
