// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/queue_delay.hpp"

#include <algorithm>
#include <cmath>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kHalfWindow = seconds{10};
constexpr Duration kStandingSpan = milliseconds{60};
constexpr std::size_t kStandingSamples = 2;  // at least
constexpr Duration kIntervalMax = milliseconds{300};
constexpr Duration kContradiction = milliseconds{30};
constexpr int kStepSamples = 6;
constexpr Duration kEmpty = milliseconds{3};

Duration known_airtime(std::size_t ip_bytes, double rate) {
  return rate > 0.0 ? Duration{std::llround(static_cast<double>(ip_bytes) * 1e6 / rate)}
                    : Duration{0};
}

}  // namespace

// The difference of the clocks modulo 2^32 us, unwrapped: it never moves by half of that at once.
Duration QueueDelay::unwrap(MeshTime sent, std::uint32_t arrived_us) {
  const auto difference = arrived_us - static_cast<std::uint32_t>(sent.time_since_epoch().count());
  if (last_difference_) {
    one_way_us_ += static_cast<std::int32_t>(difference - *last_difference_);
  }
  last_difference_ = difference;
  return Duration{one_way_us_};
}

void QueueDelay::move_window(MeshTime now) {
  const Duration age = now - window_start_;
  if (age < kHalfWindow) return;
  const bool all = age >= 2 * kHalfWindow;
  for (LeastOfWindow* window : {&one_way_, &round_trip_}) {
    window->older = all ? Least{} : window->newer;
    window->newer = {};
  }
  window_start_ = now;
}

void QueueDelay::on_sample(MeshTime now, const AckReport::Largest& sample, double rate) {
  move_window(now);
  const Duration one_way = unwrap(sample.sent, sample.arrived_us);
  const auto above = [&](LeastOfWindow& window, Duration value) {
    const Duration own = known_airtime(sample.ip_bytes, rate);
    Least& least = window.newer;
    if (least.value == Duration::max() ||
        value - own < least.value - known_airtime(least.ip_bytes, std::max(rate, least.rate))) {
      least = {value, sample.ip_bytes, rate};
    }
    least.rate = std::max(least.rate, rate);
    const Least& base = window.get();
    return value - own - (base.value - known_airtime(base.ip_bytes, std::max(rate, base.rate)));
  };
  Duration queue = std::max(above(one_way_, one_way), Duration{0});
  if (sample.rtt) {
    const Duration bound = std::max(above(round_trip_, *sample.rtt), Duration{0});
    steps_ = queue > bound + kContradiction ? steps_ + 1 : 0;
    if (steps_ >= kStepSamples) {
      one_way_ = {};
      one_way_.newer = {one_way - bound, sample.ip_bytes, rate};
      steps_ = 0;
    }
    queue = std::min(queue, bound);
  }
  update_standing(now, queue);
}

void QueueDelay::update_standing(MeshTime now, Duration queue) {
  if (count_ > 0) {
    const Sample& before = samples_[(count_ - 1) % kSamples];
    const Duration moved = queue > before.queue ? queue - before.queue : before.queue - queue;
    jitter_ = (15 * jitter_ + moved) / 16;
    interval_ = (7 * interval_ + std::min(now - before.time, kIntervalMax)) / 8;
  }
  samples_[count_++ % kSamples] = {now, queue};
  if (queue <= kEmpty) last_empty_ = now;
  const std::size_t kept = std::min(count_, kSamples);
  Duration least = queue;
  for (std::size_t used = 0; used < kept; ++used) {
    const Sample& sample = samples_[(count_ - 1 - used) % kSamples];
    if (used >= kStandingSamples && now - sample.time > kStandingSpan + 6 * jitter_) break;
    least = std::min(least, sample.queue);
  }
  standing_ = least;
}

std::optional<Duration> QueueDelay::least_rtt() const {
  const Duration value = round_trip_.get().value;
  if (value == Duration::max()) return {};
  return value;
}

}  // namespace warren::mesh
