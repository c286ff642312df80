// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/beacon_clock.hpp"

#include <algorithm>

namespace warren::mesh {
namespace {

// Even times would let two nodes that collide once collide again and again.
constexpr double kShortest = 0.8;  // of the longest period

bool is_fast(const BeaconClock::Surroundings& surroundings) {
  return surroundings.neighbours == 0 || surroundings.searching;
}

}  // namespace

Duration BeaconClock::longest(const Surroundings& surroundings) {
  if (is_fast(surroundings)) return kFastMost;
  const double bits = 8.0 * static_cast<double>(surroundings.round_bytes);
  const double mean_s = bits / kIdleBitsPerS;
  const auto for_budget = std::chrono::duration_cast<Duration>(
      std::chrono::duration<double>(mean_s * 2.0 / (1.0 + kShortest)));
  const auto neighbours = static_cast<Duration::rep>(surroundings.neighbours);
  return std::max(for_budget, kSlowLeast + neighbours * kPerNeighbour);
}

void BeaconClock::on_sent(MeshTime now, const Surroundings& surroundings) {
  sent_at_ = now;
  const Duration most = longest(surroundings);
  const auto least =
      is_fast(surroundings)
          ? kFastLeast
          : Duration(static_cast<Duration::rep>(kShortest * static_cast<double>(most.count())));
  next_ = now + jitter_.between(least, most);
}

void BeaconClock::hurry(MeshTime now) {
  if (sent_at_ == MeshTime::min()) return;
  const MeshTime soon = now + jitter_.between({}, std::chrono::milliseconds(20));
  next_ = std::min(next_, std::max(soon, sent_at_ + kHurriedLeast));
}

}  // namespace warren::mesh
