// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace warren {

// Per mask of eight lanes: the numbers of the set ones, then 0.
struct LaneNumbers {
  std::array<std::array<std::uint8_t, 8>, 256> of_mask{};
};
// Per mask of four lanes of four bytes each: the numbers of the bytes of the set ones, then 0.
struct LaneBytes {
  alignas(16) std::array<std::array<std::uint8_t, 16>, 16> of_mask{};
};

constexpr LaneNumbers lane_numbers() {
  LaneNumbers table;
  for (std::size_t mask = 0; mask < 256; ++mask) {
    std::size_t count = 0;
    for (std::uint8_t lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1) != 0) table.of_mask[mask][count++] = lane;
    }
  }
  return table;
}

constexpr LaneBytes lane_bytes() {
  LaneBytes table;
  for (std::size_t mask = 0; mask < 16; ++mask) {
    std::size_t count = 0;
    for (std::uint8_t byte = 0; byte < 16; ++byte) {
      if ((mask >> (byte / 4) & 1) != 0) table.of_mask[mask][count++] = byte;
    }
  }
  return table;
}

inline constexpr LaneNumbers kLaneNumbers = lane_numbers();
inline constexpr LaneBytes kLaneBytes = lane_bytes();

}  // namespace warren
