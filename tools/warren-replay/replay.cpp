// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-replay/replay.hpp"

#include <algorithm>
#include <utility>

namespace warren {
namespace {

constexpr double kDefaultRateHz = 10.0;
// Waits are cut into pieces, so that a Ctrl-C is noticed.
constexpr std::chrono::milliseconds kPiece{50};

}  // namespace

Replay::Replay(IngestClient& client, ScanSource& source, ReplayOptions options, Progress progress,
               const std::atomic<bool>& stop)
    : client_(client),
      source_(source),
      options_(std::move(options)),
      progress_(std::move(progress)),
      stop_(stop) {}

ReplaySummary Replay::run() {
  start_ = Clock::now();
  summary_ = {};
  summary_.scans = source_.count();
  while (going_on() && send_next()) await_turn();
  const auto deadline = Clock::now() + options_.patience;
  while (going_on() && summary_.answered() < summary_.sent && Clock::now() < deadline) {
    collect(kPiece);
  }
  if (going_on() && summary_.answered() < summary_.sent) {
    summary_.error = "the daemon did not answer for all scans";
  }
  summary_.wall_s = std::chrono::duration<double>(Clock::now() - start_).count();
  return summary_;
}

bool Replay::send_next() {
  auto recorded = source_.next();
  if (!recorded) {
    summary_.error = recorded.error();
    return false;
  }
  if (!*recorded) return false;
  const std::int64_t stamp = stamp_ns(**recorded);
  const OutgoingScan outgoing{summary_.sent, options_.sensor, options_.frame_epoch, stamp,
                              std::move((*recorded)->scan)};
  if (const auto sent = client_.send(outgoing); !sent) {
    // Why the daemon hung up stands in its last message, if it left one.
    summary_.error = sent.error();
    const auto last_words = client_.receive(std::chrono::milliseconds(0));
    if (!last_words) summary_.error = last_words.error();
    return false;
  }
  ++summary_.sent;
  summary_.points += outgoing.scan.points_sensor.size();
  progress_(summary_);
  return true;
}

// Until the next scan is due: by the clock, or when the daemon has room for it.
void Replay::await_turn() {
  if (!options_.rate_hz) {
    const std::uint64_t window = std::max<std::uint64_t>(1, client_.welcome().queue_scans);
    while (going_on() && summary_.sent - summary_.answered() >= window) collect(kPiece);
    return;
  }
  const auto due =
      start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                   static_cast<double>(summary_.sent) / *options_.rate_hz));
  while (going_on()) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(due - Clock::now());
    collect(std::clamp(left, std::chrono::milliseconds(0), kPiece));
    if (Clock::now() >= due) return;
  }
}

void Replay::collect(std::chrono::milliseconds timeout) {
  auto receipt = client_.receive(timeout);
  while (receipt && *receipt) {
    count(**receipt);
    progress_(summary_);
    receipt = client_.receive(std::chrono::milliseconds(0));
  }
  if (!receipt) summary_.error = receipt.error();
}

void Replay::count(const Receipt& receipt) {
  switch (receipt.outcome) {
    case ScanOutcome::kTaken:
      ++summary_.taken;
      break;
    case ScanOutcome::kDroppedOverload:
      ++summary_.dropped_overload;
      break;
    case ScanOutcome::kDroppedOutOfOrder:
      ++summary_.dropped_out_of_order;
      break;
    case ScanOutcome::kRejected:
      ++summary_.rejected;
      summary_.last_reason = receipt.reason;
      break;
  }
}

// The pose's own time where there is one; otherwise the rate's, for the daemon orders scans by it.
std::int64_t Replay::stamp_ns(const TimedScan& scan) const {
  const double rate_hz = options_.rate_hz.value_or(kDefaultRateHz);
  const double time_s = scan.time_s.value_or(static_cast<double>(summary_.sent + 1) / rate_hz);
  return static_cast<std::int64_t>(time_s * 1e9);
}

}  // namespace warren
