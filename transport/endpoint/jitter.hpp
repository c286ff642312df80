// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Spreads what nodes do at the same time (SplitMix64, Steele 2014). Nothing secret depends on it.
class Jitter {
 public:
  explicit Jitter(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9U;
    z = (z ^ z >> 27U) * 0x94D049BB133111EBU;
    return z ^ z >> 31U;
  }
  // Precondition: least <= most.
  Duration between(Duration least, Duration most) {
    const auto span = static_cast<std::uint64_t>((most - least).count()) + 1;
    return least + Duration(static_cast<Duration::rep>(bits() % span));
  }

 private:
  std::uint64_t state_;
};

}  // namespace warren::mesh
