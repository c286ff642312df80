// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/voxel/key.hpp"

namespace warren {

// Within a block, and of blocks within a region, places are numbered in Morton order with x lowest:
// nine bits, of which the upper three name the 4x4x4 cell, and a 2x2x2 cube is one byte of the
// cell's 64-bit mask.
inline constexpr std::array<std::uint16_t, 8> kSpread3 = {0, 1, 8, 9, 64, 65, 72, 73};

constexpr std::uint32_t morton9(std::int32_t x, std::int32_t y, std::int32_t z) {
  return kSpread3[static_cast<std::size_t>(x & 7)] |
         static_cast<std::uint32_t>(kSpread3[static_cast<std::size_t>(y & 7)]) << 1 |
         static_cast<std::uint32_t>(kSpread3[static_cast<std::size_t>(z & 7)]) << 2;
}

constexpr std::int32_t compact3(std::uint32_t code) {
  return static_cast<std::int32_t>((code & 1) | ((code >> 2) & 2) | ((code >> 4) & 4));
}

// The place (0..7 per axis) that has this number.
constexpr VoxelKey place_of_morton9(std::uint32_t code) {
  return {compact3(code), compact3(code >> 1), compact3(code >> 2)};
}

}  // namespace warren
