// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>

#include "daemon/mapper/mapper.hpp"

namespace warren {

// Feeds the service manager's watchdog only while both threads make progress: its timer runs on the
// io thread, and between two of its ticks the mapping thread must have answered or taken a scan.
class Watchdog {
 public:
  Watchdog(asio::io_context& io, Mapper& mapper, std::function<void()> feed)
      : timer_(io), mapper_(mapper), feed_(std::move(feed)) {}

  // Ticks four times per `time`, in which the service manager wants to be fed once.
  void start(std::chrono::microseconds time) {
    period_ = time / kTicksPerTime;
    tick();
  }
  void stop() {
    stopped_ = true;
    timer_.cancel();
  }

 private:
  static constexpr int kTicksPerTime = 4;

  void tick() {
    const std::uint64_t beats = mapper_.beats();
    if (beats != last_beats_) feed_();
    last_beats_ = beats;
    mapper_.request_beat();
    timer_.expires_after(period_);
    timer_.async_wait([this](std::error_code cancelled) {
      if (!cancelled && !stopped_) tick();
    });
  }

  asio::steady_timer timer_;
  Mapper& mapper_;
  std::function<void()> feed_;
  std::chrono::microseconds period_{};
  std::uint64_t last_beats_ = 0;
  bool stopped_ = false;
};

}  // namespace warren
