// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/received_packets.hpp"

#include <algorithm>
#include <cmath>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kAckBytes = 90;      // IP bytes of a packet that only acknowledges
constexpr double kAckShare = 0.025;        // of the bytes that arrive
constexpr std::size_t kPacketsPerAck = 2;  // at least
constexpr Duration kDelayMin = milliseconds{2};
constexpr Duration kDelayMax = milliseconds{25};         // for one packet alone
constexpr Duration kAckIntervalMax = milliseconds{160};  // between two, on the slowest links
constexpr Duration kRest = milliseconds{500};            // after which
constexpr int kQuickPackets = 16;                        // are acknowledged at once
constexpr Duration kRepeatDelay = milliseconds{40};
constexpr int kTellTimes = 6;                 // a range, since its last change
constexpr int kOlderRanges = 5;               // besides, as many acknowledgements may be lost
constexpr std::uint32_t kWholeAckPeriod = 8;  // between acknowledgements with all ranges
constexpr double kLossGain = 1.0 / 64.0;
constexpr std::uint64_t kLossStep = 64;  // packets that one gap may count for

Duration clamp_us(double us, Duration low, Duration high) {
  return std::clamp(Duration{std::llround(std::min(us, 1e12))}, low, high);
}

}  // namespace

void ReceivedPackets::on_received(MeshTime now, const Packet& packet) {
  if (now - last_arrival_ > kRest || ranges_.empty()) quick_ = kQuickPackets;
  measure_loss(packet.number);
  measure_rate(now, packet.ip_bytes);
  add_number(packet.number);
  add_pairs({packet.number, now, packet.ip_bytes});
  schedule(now, packet.wants_ack);
}

void ReceivedPackets::add_number(std::uint64_t number) {
  // First range that begins at or below the number.
  const auto at = std::find_if(ranges_.begin(), ranges_.end(),
                               [&](const Range& range) { return range.first <= number; });
  if (at != ranges_.end() && number < at->end) return;
  const bool joins_lower = at != ranges_.end() && at->end == number;
  const bool joins_higher = at != ranges_.begin() && std::prev(at)->first == number + 1;
  if (joins_lower && joins_higher) {
    std::prev(at)->first = at->first;
    std::prev(at)->told = 0;
    ranges_.erase(at);
  } else if (joins_lower) {
    ++at->end;
    at->told = 0;
  } else if (joins_higher) {
    --std::prev(at)->first;
    std::prev(at)->told = 0;
  } else {
    ranges_.insert(at, Range{{number, number + 1}});
    if (ranges_.size() > AckFrame::kRangesMax) ranges_.pop_back();
  }
}

const ReceivedPackets::Arrival* ReceivedPackets::arrival(std::uint64_t number) const {
  const Arrival& kept = arrivals_[number % kArrivals];
  return kept.ip_bytes > 0 && kept.number == number ? &kept : nullptr;
}

void ReceivedPackets::add_pairs(const Arrival& now) {
  const auto add = [this](const Arrival& first, const Arrival& second) {
    const Duration gap = second.time - first.time;
    if (gap > AckFrame::kPairGapMax || gap < -AckFrame::kPairGapMax) return;
    pair_bytes_ += static_cast<std::uint32_t>(second.ip_bytes);
    pair_us_ += static_cast<std::uint32_t>(gap.count());
  };
  if (now.number > 0) {
    if (const Arrival* before = arrival(now.number - 1)) add(*before, now);
  }
  if (const Arrival* after = arrival(now.number + 1)) add(now, *after);
  arrivals_[now.number % kArrivals] = now;
}

void ReceivedPackets::measure_loss(std::uint64_t number) {
  if (ranges_.empty()) return;
  const std::uint64_t expected = ranges_.front().end;
  if (number < expected) {  // held lost when it was overtaken
    loss_ = std::max(0.0, loss_ - kLossGain * (1.0 - kLossGain));
    return;
  }
  const auto missing = std::min(number - expected, kLossStep);
  for (std::uint64_t i = 0; i < missing; ++i) loss_ += (1.0 - loss_) * kLossGain;
  loss_ -= loss_ * kLossGain;
}

void ReceivedPackets::measure_rate(MeshTime now, std::size_t ip_bytes) {
  constexpr double kSpanUs = 200'000.0;
  const double passed = static_cast<double>((now - last_arrival_).count());
  rate_ = rate_ * std::exp(-passed / kSpanUs) + static_cast<double>(ip_bytes) * 1e6 / kSpanUs;
  last_arrival_ = now;
}

void ReceivedPackets::schedule(MeshTime now, bool wants_ack) {
  if (!wants_ack) return;
  ++unacked_;
  repeat_ = false;
  Duration interval = clamp_us(kAckBytes * 1e6 / (kAckShare * rate_), kDelayMin, kAckIntervalMax);
  if (quick_ > 0) {
    --quick_;
    interval = kDelayMin;
  }
  const MeshTime earliest = std::max(now, last_ack_ + interval);
  const MeshTime at_last = std::max(earliest, now + std::max(interval, kDelayMax));
  const MeshTime due = unacked_ >= kPacketsPerAck ? earliest : at_last;
  due_at_ = unacked_ == 1 ? due : std::min(due_at_, due);
}

std::optional<AckFrame> ReceivedPackets::take_ack(MeshTime now) {
  if (ranges_.empty()) return {};
  AckFrame ack;
  const bool whole = acks_++ % kWholeAckPeriod == 0;
  int older = 0;
  for (Range& range : ranges_) {
    const bool news = range.told < kTellTimes || ack.ranges.empty();
    if (news || whole || older++ < kOlderRanges) ack.ranges.push_back(range);
    range.told = std::min(range.told + 1, kTellTimes);
  }
  const Arrival* largest = arrival(ranges_.front().end - 1);
  const MeshTime arrived = largest != nullptr ? largest->time : now;
  ack.arrived_us = static_cast<std::uint32_t>(arrived.time_since_epoch().count());
  ack.delay = std::min(now - arrived, Duration{0xffff'ffff});
  ack.pair_bytes = pair_bytes_;
  ack.pair_us = pair_us_;

  repeat_ = unacked_ > 0;
  due_at_ = repeat_ ? now + kRepeatDelay : kNever;
  unacked_ = 0;
  last_ack_ = now;
  return ack;
}

}  // namespace warren::mesh
