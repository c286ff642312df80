// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "transport/endpoint/jitter.hpp"
#include "transport/mesh_time.hpp"

namespace warren::mesh {

// When this node beacons: often while it hears nobody or misses someone for whom it has something,
// else so seldom that all beacons together cost kIdleBitsPerS, and less in a crowd, where others
// are heard sooner anyway. Never slower than that, however long the silence lasts.
class BeaconClock {
 public:
  static constexpr Duration kFastLeast = std::chrono::milliseconds(200);
  static constexpr Duration kFastMost = std::chrono::milliseconds(250);
  static constexpr Duration kSlowLeast = std::chrono::milliseconds(800);
  static constexpr Duration kPerNeighbour = std::chrono::milliseconds(50);
  static constexpr double kIdleBitsPerS = 900.0;
  // The shortest time between two of them, whatever hurries.
  static constexpr Duration kHurriedLeast = std::chrono::milliseconds(150);

  struct Surroundings {
    std::size_t neighbours = 0;   // heard lately
    bool searching = false;       // someone is missed
    std::size_t round_bytes = 0;  // IP bytes of one beacon to all its destinations
  };

  explicit BeaconClock(std::uint64_t seed) : jitter_(seed) {}

  MeshTime next() const { return next_; }
  // The longest time until the one after, to be told in this one.
  static Duration longest(const Surroundings& surroundings);
  void on_sent(MeshTime now, const Surroundings& surroundings);
  // Soon, because somebody has appeared who does not know us or misses us.
  void hurry(MeshTime now);

 private:
  Jitter jitter_;
  MeshTime sent_at_ = MeshTime::min();
  MeshTime next_ = MeshTime::min();
};

}  // namespace warren::mesh
