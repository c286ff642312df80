// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>

#include "daemon/fleet/fleet.hpp"
#include "daemon/mapper/mapper.hpp"

namespace warren {

// Feeds the service manager's watchdog only while all threads make progress: its timer runs on the
// io thread, and between two of its ticks the mapping thread must have answered or taken a scan,
// and the fleet thread and that of the store, if there is one, have answered. That of files, whose
// work takes as long as a disk takes, is looked after by `feed`.
class Watchdog {
 public:
  Watchdog(asio::io_context& io, Mapper& mapper, Fleet& fleet, std::function<void()> feed)
      : timer_(io), mapper_(mapper), fleet_(fleet), feed_(std::move(feed)) {}

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
  struct Beats {
    std::uint64_t mapper = 0;
    std::uint64_t fleet = 0;
    std::uint64_t store = 0;
  };

  void tick() {
    const Beats beats{mapper_.beats(), fleet_.beats(), fleet_.store_beats()};
    const bool store_lives = !fleet_.has_store() || beats.store != last_.store;
    if (beats.mapper != last_.mapper && beats.fleet != last_.fleet && store_lives) feed_();
    last_ = beats;
    mapper_.request_beat();
    fleet_.request_beat();
    timer_.expires_after(period_);
    timer_.async_wait([this](std::error_code cancelled) {
      if (!cancelled && !stopped_) tick();
    });
  }

  asio::steady_timer timer_;
  Mapper& mapper_;
  Fleet& fleet_;
  std::function<void()> feed_;
  std::chrono::microseconds period_{};
  Beats last_;
  bool stopped_ = false;
};

}  // namespace warren
