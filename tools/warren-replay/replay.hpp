// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tools/client/ingest_client.hpp"
#include "tools/warren-replay/scan_source.hpp"

namespace warren {

struct ReplayOptions {
  std::string sensor;
  std::uint64_t frame_epoch = 0;
  // Scans per second; nothing: as fast as the daemon takes them, without a drop.
  std::optional<double> rate_hz = 10.0;
  // How long to wait for the receipts still owed after the last scan.
  std::chrono::milliseconds patience = std::chrono::seconds(60);
};

struct ReplaySummary {
  std::uint64_t scans = 0;  // in all
  std::uint64_t sent = 0;
  std::uint64_t taken = 0;
  std::uint64_t dropped_overload = 0;
  std::uint64_t dropped_out_of_order = 0;
  std::uint64_t rejected = 0;
  std::uint64_t points = 0;
  double wall_s = 0.0;
  std::string last_reason;  // why the last scan was rejected
  std::string error;        // what ended the replay early; empty if nothing did

  std::uint64_t answered() const {
    return taken + dropped_overload + dropped_out_of_order + rejected;
  }
  bool complete() const { return error.empty() && sent == scans && answered() == sent; }
};

// Sends scans to a daemon. Calls progress after every scan sent and every receipt. Ends
// early, with what it has, when `stop` becomes true.
class Replay {
 public:
  using Progress = std::function<void(const ReplaySummary&)>;

  Replay(IngestClient& client, ScanSource& source, ReplayOptions options, Progress progress,
         const std::atomic<bool>& stop);
  ReplaySummary run();

 private:
  using Clock = std::chrono::steady_clock;

  bool send_next();
  void await_turn();
  void collect(std::chrono::milliseconds timeout);
  void count(const Receipt& receipt);
  bool going_on() const { return summary_.error.empty() && !stop_; }
  std::int64_t stamp_ns(const TimedScan& scan) const;

  IngestClient& client_;
  ScanSource& source_;
  ReplayOptions options_;
  Progress progress_;
  const std::atomic<bool>& stop_;
  Clock::time_point start_;
  ReplaySummary summary_;
};

}  // namespace warren
