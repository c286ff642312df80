// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/flow.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "transport/flow/node_pacer.hpp"

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;

constexpr Duration kSilence = milliseconds{1500};  // without progress, beyond round trips
constexpr Duration kQuiet = milliseconds{100};
constexpr double kQuietShare = 1.0;  // of the rate, while it is quiet
constexpr Duration kProbeMin = milliseconds{20};
constexpr Duration kProbeMax = milliseconds{200};
constexpr double kRepeatShare = 0.04;  // of the bytes sent for the first time
constexpr double kRepeatBytesMax = 6'000.0;
constexpr double kRepeatSecondsMax = 0.01;    // of the rate, on fast links
constexpr std::size_t kAtOnceBytes = 64'000;  // beyond what may be in flight

}  // namespace

Flow::Flow(const RateController::Config& config) : rate_(config) {}

void Flow::on_sent(MeshTime now, Sent sent) {
  if (sent.wants_ack && sent_.packets_in_flight() == 0) last_progress_ = now;
  if (sent.wants_ack) last_probe_ = now;
  const double bytes = static_cast<double>(sent.ip_bytes);
  if (sent.repeat) {
    repeat_bytes_ -= bytes;
  } else {
    const double most = std::max(kRepeatBytesMax, kRepeatSecondsMax * rate_.rate());
    repeat_bytes_ = std::min(repeat_bytes_ + kRepeatShare * bytes, most);
  }
  // Full in flight is no want of something to send either.
  const bool full =
      rate_.known() && sent_.bytes_in_flight() + 2 * sent.ip_bytes > in_flight_max(now);
  // What a packet waits beyond the airtime of our own before it went to other peers.
  const Duration spacing = now - last_sent_;
  const Duration own = sent.backlogged ? std::min(own_ahead_, spacing) : spacing;
  own_ahead_ = std::clamp(own_ahead_ - spacing, Duration{0}, NodePacer::kAheadMax) +
               Duration{std::llround(bytes * 1e6 / rate_.pace())};
  last_sent_ = now;
  sent_.on_sent(sent.number, {.sent = now,
                              .ip_bytes = sent.ip_bytes,
                              .own = own,
                              .busy = sent.backlogged || full,
                              .wants_ack = sent.wants_ack,
                              .tickets = std::move(sent.tickets)});
  next_number_ = sent.number + 1;
}

void Flow::on_received(MeshTime now, const ReceivedPackets::Packet& packet) {
  received_.on_received(now, packet);
}

Flow::Outcome Flow::on_ack(MeshTime now, const AckFrame& ack) {
  SentPackets::Settled settled = sent_.on_ack(now, ack);
  if (settled.report.newly_acked > 0) {
    last_progress_ = now;
    silent_ = false;
    rate_.on_ack(now, ack, settled.report, next_number_);
  }
  return {std::move(settled.acked), std::move(settled.lost)};
}

void Flow::on_heard(MeshTime now) {
  if (silent_) last_probe_ = now - kProbeMax;
}

Flow::Outcome Flow::on_time(MeshTime now) {
  last_time_ = now;
  SentPackets::Settled settled = sent_.on_time(now);
  if (!silent_ && now >= silence_time()) {
    silent_ = true;
    rate_.on_silence();
  }
  return {std::move(settled.acked), std::move(settled.lost)};
}

Flow::Outcome Flow::abandon() {
  Outcome outcome;
  outcome.lost = sent_.abandon();
  return outcome;
}

void Flow::on_path_changed(MeshTime now) {
  rate_.forget_path(next_number_);
  sent_.forget_path();
  silent_ = false;
  last_progress_ = now;
}

MeshTime Flow::silence_time() const {
  if (silent_ || last_progress_ == kNever) return kNever;
  const Duration trip = sent_.smoothed_rtt().value_or(milliseconds{400});
  const bool waiting = sent_.packets_in_flight() > 0 || last_probe_ > last_progress_;
  return waiting ? last_progress_ + kSilence + 2 * trip : kNever;
}

// The share of the rate that still goes out falls as the silence lasts, as its inverse.
Duration Flow::probe_period() const {
  if (!rate_.known()) return kProbeMax;
  const Duration waited = std::max(last_probe_ - last_progress_, kSilence);
  const double share = static_cast<double>(kSilence.count()) / static_cast<double>(waited.count());
  const double us = static_cast<double>(packet_bytes()) * 1e6 / (share * rate_.rate());
  return std::clamp(Duration{std::llround(us)}, kProbeMin, kProbeMax);
}

MeshTime Flow::next_time() const {
  MeshTime next = std::min({sent_.loss_time(), received_.due_at(), silence_time()});
  const MeshTime may_send_at =
      silent_ ? last_probe_ + probe_period() : std::max(rate_.paused_until(), room_time());
  if (may_send_at > last_time_) next = std::min(next, may_send_at);
  return next;
}

// When in_flight_max() will have grown to what may_send() asks for, if no acknowledgement comes.
MeshTime Flow::room_time() const {
  const std::size_t wanted = sent_.bytes_in_flight() + packet_bytes();
  const std::size_t most = rate_.in_flight_max();
  if (wanted <= most) return MeshTime::min();
  if (!rate_.known()) return kNever;
  const double more_s = static_cast<double>(wanted - most + 1) / (kQuietShare * rate_.rate());
  return last_progress_ + kQuiet + Duration{std::llround(std::ceil(more_s * 1e6))};
}

// When acknowledgements stay away altogether, rather than come slowly, they are lost: it goes on.
std::size_t Flow::in_flight_max(MeshTime now) const {
  const double waited = static_cast<double>((now - last_progress_ - kQuiet).count()) * 1e-6;
  const double more = rate_.known() ? kQuietShare * rate_.rate() * std::max(waited, 0.0) : 0.0;
  return rate_.in_flight_max() + static_cast<std::size_t>(more);
}

bool Flow::may_send(MeshTime now) const {
  if (!sent_.room()) return false;
  if (silent_) return now >= last_probe_ + probe_period();
  if (now < rate_.paused_until()) return false;
  return sent_.bytes_in_flight() + packet_bytes() <= in_flight_max(now);
}

bool Flow::may_send_at_once(MeshTime now) const {
  return sent_.bytes_in_flight() <= in_flight_max(now) + kAtOnceBytes;
}

LinkQuality Flow::quality() const {
  LinkQuality quality;
  quality.rtt = sent_.smoothed_rtt();
  quality.loss_out = sent_.loss();
  quality.loss_in = received_.loss();
  quality.rate_bit_s = rate_.known() ? rate_.rate() * 8.0 : 0.0;
  quality.queue = rate_.queue();
  return quality;
}

std::optional<std::vector<Ticket>> Flow::take_repeat(MeshTime now) {
  if (silent_ || repeat_bytes_ < static_cast<double>(packet_bytes())) return {};
  const Duration trip = sent_.smoothed_rtt().value_or(milliseconds{400});
  return sent_.take_repeat(now - trip / 4);
}

std::size_t Flow::memory_bytes() const { return sizeof(*this) + sent_.memory_bytes(); }

}  // namespace warren::mesh
