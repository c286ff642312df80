// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace warren::world {

// SplitMix64 (Steele, Lea, Flood 2014). The standard library's distributions differ between
// libraries; these do not: the same seed gives the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  // [low, high)
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  // [0, count)
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((next() >> 32) * count) >> 32);
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  // Standard normal (Box-Muller).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(0.0, 1.0));
  }
  // A generator for a part of the work that does not disturb this one's sequence.
  Random fork(std::uint64_t purpose) const {
    Random other(state_ ^ (purpose * 0xD1B54A32D192ED03ULL + 1));
    return Random(other.next());
  }

 private:
  std::uint64_t state_;
};

}  // namespace warren::world
