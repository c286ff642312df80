// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/rate_controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "transport/flow/seconds.hpp"

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kFirstRate = 500'000.0;  // IP bytes/s, of the first packets
constexpr double kCautiousRate = 50'000.0;
constexpr double kRateMin = 1'000.0;
constexpr double kRateMax = 1e9;
constexpr std::size_t kFirstPackets = 8;  // in flight until something is known
constexpr std::size_t kFirstPacketBytes = 400;
constexpr double kFirstBytes = 800.0;     // less, in small packets, says nothing of the link
constexpr double kStartGrowth = 4.0;      // in flight, per byte acknowledged while starting
constexpr double kPacketOverhead = 80.0;  // IP bytes around what a packet carries
constexpr double kAirtimeWorth = 0.66;    // seconds of airtime that weigh as much as all bytes

constexpr Duration kTargetFloor = milliseconds{8};
constexpr Duration kTargetSlope = milliseconds{14};  // at 1 Mbit/s; falls with the root of the rate
constexpr Duration kTargetMax = milliseconds{45};
constexpr double kTargetRate = 125'000.0;
constexpr Duration kInFlightQueue = milliseconds{150};
constexpr std::size_t kInFlightPackets = 2;

constexpr double kBusy = 0.7;  // of the time: less says little of the link
constexpr double kFirstCaution = 0.8;
constexpr double kGainSecond = 1.25;  // after a first flight that the link stretched
constexpr double kGainFirst = 1.06;
constexpr double kGainGrowth = 4.0;  // of what is above 1
constexpr double kGainMax = 2.0;
constexpr double kRaiseMax = 0.06;  // of the pace, while the queue is below its target
constexpr double kLowerMax = 0.5;
constexpr double kCertainty = 2.0;  // a probe's effect over the jitter
constexpr double kCertain = 0.03;   // of a rate: taken as it is
constexpr double kFallMax = 0.05;   // for one probe that failed
constexpr int kPlateauRounds = 6;
constexpr Duration kPlateauMax = seconds{1};
constexpr double kGainQueued = 1.12;
constexpr Duration kStillMin = seconds{2};
constexpr int kStillRtts = 6;
constexpr double kRoundPairs = 4.0;
constexpr Duration kRoundMax = seconds{1};
constexpr double kGiveUpPackets = 20.0;  // arrived without a pair
constexpr Duration kFollowSpan = milliseconds{200};
constexpr Duration kJoinAfter = seconds{2};
constexpr Duration kEmptyPeriod = seconds{8};

}  // namespace

RateController::RateController(const Config& config)
    : config_(config), rate_(kFirstRate), gain_(1.0) {
  round_.from.emplace();
}

void RateController::on_ack(MeshTime now, const AckFrame& ack, const AckReport& report,
                            std::uint64_t next) {
  arrivals_.on_ack(now, ack, report);
  if (report.largest) queue_.on_sample(now, *report.largest, confirmed_rate_);
  loss_ = report.loss;
  if (starting_) start_bytes_ = report.acked_bytes;
  skip_pauses(report);
  if (!known_) return judge_first_flight(report, next);
  fall_fast(now, next);
  follow_arrivals(now);
  watch_round(now, report, next);
  empty_queue_sometimes(now);
}

// What is measured begins after them.
void RateController::skip_pauses(const AckReport& report) {
  if (!round_.from || round_.from->sent.pauses == arrivals_.mark().sent.pauses) return;
  round_.from = arrivals_.mark();
  round_.first = report.end;
}

// A queue well above the target: the link became slower, or the search for more went too far.
void RateController::fall_fast(MeshTime now, std::uint64_t next) {
  const bool searching = gain_ > 1.0 || starting_;
  const Duration limit = searching ? 2 * target() : target() + milliseconds{40};
  if (queue_.standing() < limit + queue_.jitter()) return;
  const auto seen = arrivals_.since(now - milliseconds{30} - 10 * queue_.jitter(), 4.0);
  if (!seen) return;
  const double seen_rate = seen->busy > kBusy ? seen->arrival_rate : seen->rate;
  if (searching) {
    set_rate(std::min(seen_rate, rate_ * gain_));
    stop_search();
    begin_round(next);
  } else if (seen_rate < 0.93 * rate_) {
    set_rate(seen_rate);
  }
}

// While a queue stands, what arrives is what the link carries.
void RateController::follow_arrivals(MeshTime now) {
  if (starting_ || gain_ > 1.0 || !queue_shows()) {
    queued_since_ = now;
    return;
  }
  const Duration span = std::max({round_trip(), kFollowSpan, 20 * queue_.jitter()});
  const auto seen = arrivals_.since(std::max(now - span, queued_since_), 8.0, queued_since_);
  if (!seen || seen->busy < kBusy) return;
  const double certain = std::min(1.0, kCertain / uncertainty(*seen));
  const double share = std::min(in_seconds(now - last_followed_) / 0.1, 1.0) * certain * certain;
  set_rate(rate_ + (seen->arrival_rate - rate_) * share);
  confirmed_rate_ = rate_;
  last_followed_ = now;
}

// The first packets go out close together. If they arrive further apart, that is the link's rate;
// else the link is faster yet.
void RateController::judge_first_flight(const AckReport& report, std::uint64_t next) {
  const auto seen = arrivals_.since(*round_.from);
  if (!seen || seen->pairs < 2.0 || seen->bytes < kFirstBytes) {
    // Too few of it arrived to tell.
    if (report.end < round_.first + kFirstPackets + 1) return;
    set_rate(kCautiousRate);
    gain_ = kGainMax;
    return begin_round(next);
  }
  const bool limited = seen->stretch > 1.2;
  set_rate(limited ? seen->rate * kFirstCaution : pace());
  gain_ = limited ? kGainSecond : kGainMax;
  begin_round(next);
}

void RateController::begin_round(std::uint64_t next) {
  round_ = {};
  round_.first = next;
}

void RateController::watch_round(MeshTime now, const AckReport& report, std::uint64_t next) {
  if (queue_shows()) round_.queued = true;
  if (queue_.standing() + queue_.jitter() > 3 * target() / 4) queue_grew_ = now;
  if (!round_.from) {
    if (report.end > round_.first) round_.from = arrivals_.mark();
    return;
  }
  const double excess = gain_ > 1.0 ? gain_ - 1.0 : kGainFirst - 1.0;
  const Duration certain = from_seconds(kCertainty * in_seconds(queue_.jitter()) / excess);
  const Duration span =
      std::max({round_trip() / 4, std::min(certain, kRoundMax), Duration{milliseconds{10}}});
  if (now - round_.from->time < span) return;
  const ArrivalRate::Mark& here = arrivals_.mark();
  const double busy = here.busy_acked_bytes - round_.from->busy_acked_bytes;
  if (busy < kBusy * (here.acked_bytes - round_.from->acked_bytes)) {
    // Too little was sent to learn from; what is sent from now on may do.
    if (now - round_.from->time > kRoundMax) begin_round(next);
    return;
  }
  const auto seen = arrivals_.since(*round_.from);
  if (!seen || seen->pairs < kRoundPairs) return give_up_round(now, next);
  end_round(now, *seen);
  begin_round(next);
}

void RateController::stop_search() {
  gain_ = 1.0;
  starting_ = false;
  through_queue_ = false;
}

void RateController::wait_at_plateau(MeshTime now) {
  stop_search();
  patience_ = kPlateauRounds;
  plateau_since_ = now;
}

// At twice the link's rate a short buffer drops every second packet: none is left that arrived
// next to its neighbour.
void RateController::give_up_round(MeshTime now, std::uint64_t next) {
  const double seconds = in_seconds(now - round_.from->time);
  const double delivered = arrivals_.mark().acked_bytes - round_.from->acked_bytes;
  const double enough = kGiveUpPackets * static_cast<double>(packet_bytes());
  if (delivered <= enough || seconds < in_seconds(round_trip())) return;
  set_rate(std::clamp(1.1 * delivered / seconds, 0.7 * rate_, rate_));
  wait_at_plateau(now);
  begin_round(next);
}

void RateController::end_round(MeshTime now, const ArrivalRate::Measure& seen) {
  if (round_.queued && !starting_ && !through_queue_) {
    gain_ = 1.0;
    patience_ = 0;
    // A queue that does not grow towards its target, though the pace is above the rate, may be
    // none: the path became longer.
    if (now - queue_grew_ < std::max(kStillMin, kStillRtts * round_trip())) return;
    queue_grew_ = now;
    through_queue_ = true;
    gain_ = kGainQueued;
    return;
  }
  if (patience_ > 0) {
    patience_ = now - plateau_since_ > kPlateauMax ? 0 : patience_ - 1;
    if (patience_ == 0) gain_ = kGainFirst;
    return;
  }
  const double passed = 1.0 / seen.stretch;  // of the pace
  const double full = 1.0 / gain_;           // what passes if the link is full already
  const double doubt = uncertainty(seen);
  const double needed =
      std::max(1.0 - std::max(0.03, 0.4 * (1.0 - full)) - 0.7 * doubt, full + 0.25 * (1.0 - full));
  if (passed >= needed) {
    set_rate(std::max(rate_, rate_ * gain_ * std::min(passed, 1.0)));
    // Not all of it passed: that is the link's rate, or near it.
    const bool all = passed >= 0.5 * (1.0 + full);
    const double next = all ? 1.0 + kGainGrowth * (gain_ - 1.0) : kGainFirst;
    gain_ = std::clamp(next, kGainFirst, kGainMax);
    through_queue_ = through_queue_ && all;
  } else {
    const double fall = kFallMax * std::clamp(kCertain / doubt, 0.3, 1.0);
    set_rate(std::clamp(seen.rate, rate_ * (1.0 - fall), rate_ * gain_));
    wait_at_plateau(now);
  }
}

// The base of the delay is only seen while the queue is empty; and a neighbour's flow that never
// saw it empty takes ours for a part of its base.
void RateController::empty_queue_sometimes(MeshTime now) {
  const Duration full = queue_.last_empty() - std::exchange(last_empty_, queue_.last_empty());
  if (starting_) return;
  // Somebody else has just emptied it: joining in gets to the bottom.
  const bool join = full > kJoinAfter && now - last_pause_ > kJoinAfter;
  if (!join && !queue_shows()) return;
  if (!join && now - std::max(queue_.last_empty(), last_pause_) < kEmptyPeriod) return;
  last_pause_ = now;
  paused_until_ = now + 2 * std::max(queue_.standing(), target() / 2) + target() / 2;
}

void RateController::on_silence() {
  gain_ = std::max(gain_, kGainFirst);
  patience_ = 0;
}

void RateController::forget_path(std::uint64_t next) {
  const ArrivalRate arrivals = arrivals_;
  *this = RateController(config_);
  arrivals_ = arrivals;
  round_ = {.first = next, .from = arrivals_.mark()};
}

void RateController::set_rate(double rate) {
  rate_ = std::clamp(rate, kRateMin, kRateMax);
  known_ = true;
}

// Less for fast flows: two that share a queue find the same rate.
Duration RateController::target() const {
  const double slope = in_seconds(kTargetSlope) * std::sqrt(kTargetRate / rate_);
  return std::min(kTargetFloor + from_seconds(slope), Duration{kTargetMax});
}

bool RateController::queue_shows() const {
  return queue_.standing() >= target() / 4 + queue_.jitter() / 2;
}

// What jitter does to a measure of arrival spacing: each run of packets without a loss within is
// wrong by that of its first and its last.
double RateController::uncertainty(const ArrivalRate::Measure& seen) const {
  const double runs = 1.0 + seen.pairs * loss_;
  const double wrong_s = 1.25 * in_seconds(queue_.jitter()) * std::sqrt(runs);
  return std::max(wrong_s / std::max(seen.seconds, 1e-3), 1e-6);
}

double RateController::pace() const {
  double pace = rate_ * gain_;
  if (!starting_ && gain_ <= 1.0) {
    const double reaction = std::max(0.3, 2.5 * in_seconds(round_trip() + 2 * queue_.interval()));
    const double room = in_seconds(target() - queue_.standing()) / reaction;
    pace = rate_ * (1.0 + std::clamp(room, -kLowerMax, kRaiseMax));
  }
  if (config_.ceiling_bit_s) pace = std::min(pace, *config_.ceiling_bit_s / 8.0);
  return std::max(pace, kRateMin);
}

std::size_t RateController::in_flight_max() const {
  if (!known_) return kFirstPackets * packet_bytes();
  double bytes = std::max(pace(), rate_) * in_seconds(round_trip() + kInFlightQueue);
  if (starting_) bytes = std::min(bytes, kStartGrowth * start_bytes_);
  return kInFlightPackets * packet_bytes() + static_cast<std::size_t>(bytes);
}

// Headers are a share of each packet, its airtime is waited for by all behind it: the sum of
// overhead / bytes and bytes / rate / worth is the least here. 575 bytes at 50 kbit/s.
std::size_t RateController::packet_bytes() const {
  if (!known_) return std::min(kFirstPacketBytes, config_.packet_bytes_max);
  const auto bytes = static_cast<std::size_t>(std::sqrt(kPacketOverhead * rate_ * kAirtimeWorth));
  return std::clamp(bytes, std::min(config_.packet_bytes_min, config_.packet_bytes_max),
                    config_.packet_bytes_max);
}

}  // namespace warren::mesh
