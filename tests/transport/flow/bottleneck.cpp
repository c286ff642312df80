// SPDX-License-Identifier: Apache-2.0
#include "bottleneck.hpp"

#include <algorithm>
#include <cmath>

namespace warren::mesh {

double Bottleneck::rate_at(MeshTime time) const {
  double rate = config_.rate_bit_s.front().second;
  for (const auto& [from, value] : config_.rate_bit_s) {
    if (time.time_since_epoch() >= from) rate = value;
  }
  return rate;
}

MeshTime Bottleneck::transmitted(MeshTime from, double bits) const {
  MeshTime at = from;
  for (const auto& [start, rate] : config_.rate_bit_s) {  // steps that fall within the sending
    const MeshTime step = MeshTime{start};
    if (step <= at) continue;
    const double fits = rate_at(at) * static_cast<double>((step - at).count()) * 1e-6;
    if (fits >= bits) break;
    bits -= fits;
    at = step;
  }
  return at + Duration{std::llround(bits * 1e6 / rate_at(at))};
}

Duration Bottleneck::queue(MeshTime now) const { return std::max(free_at_ - now, Duration{0}); }

bool Bottleneck::lost_on_air(MeshTime now) {
  const Duration at = now.time_since_epoch();
  if (at >= config_.blackout.first && at < config_.blackout.second) return true;
  if (config_.burst_packets <= 0.0) return uniform() < config_.loss;
  const double leave = 1.0 / config_.burst_packets;
  const double enter = leave * config_.loss / (1.0 - config_.loss);
  in_burst_ = in_burst_ ? uniform() >= leave : uniform() < enter;
  return in_burst_;
}

void Bottleneck::send(MeshTime now, const BottleneckPacket& packet) {
  bytes_offered_ += packet.ip_bytes;
  while (!departures_.empty() && departures_.front() <= now) departures_.pop_front();
  const std::size_t waiting = departures_.empty() ? 0 : departures_.size() - 1;
  if (waiting >= config_.buffer_packets || queue(now) > config_.buffer_delay) {
    ++packets_overflowed_;
    return;
  }
  free_at_ = transmitted(std::max(now, free_at_), static_cast<double>(packet.ip_bytes) * 8.0);
  departures_.push_back(free_at_);
  const Duration jitter{std::llround(uniform() * static_cast<double>(config_.jitter.count()))};
  if (lost_on_air(free_at_)) return;
  const bool longer = free_at_.time_since_epoch() >= config_.longer.first;
  const Duration delay = config_.delay + (longer ? config_.longer.second : Duration{0});
  air_.push({free_at_ + delay + jitter, order_++, packet});
}

BottleneckPacket Bottleneck::take_arrival() {
  const BottleneckPacket packet = air_.top().packet;
  air_.pop();
  return packet;
}

}  // namespace warren::mesh
