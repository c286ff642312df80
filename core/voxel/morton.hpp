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

// Morton code of a voxel in the whole key space: 48 bits, x lowest. Its low 9 bits are the place in
// the block, the next 9 the block's in the region, the rest name the region.
inline constexpr std::array<std::uint64_t, 3> kMortonAxis = {0x249249249249ULL, 0x492492492492ULL,
                                                             0x924924924924ULL};

constexpr std::uint64_t morton_spread(std::uint64_t bits) {
  bits = (bits | bits << 16) & 0xFF0000FFULL;
  bits = (bits | bits << 8) & 0xF00F00F00FULL;
  bits = (bits | bits << 4) & 0xC30C30C30C3ULL;
  return (bits | bits << 2) & kMortonAxis[0];
}

constexpr std::int32_t morton_compact(std::uint64_t bits) {
  bits &= kMortonAxis[0];
  bits = (bits | bits >> 2) & 0xC30C30C30C3ULL;
  bits = (bits | bits >> 4) & 0xF00F00F00FULL;
  bits = (bits | bits >> 8) & 0xFF0000FFULL;
  return static_cast<std::int32_t>((bits | bits >> 16) & 0xFFFF);
}

constexpr std::uint64_t morton_of(const VoxelKey& key) {
  const auto from_zero = [](std::int32_t axis) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(axis - kKeyMin));
  };
  return morton_spread(from_zero(key.x)) | morton_spread(from_zero(key.y)) << 1 |
         morton_spread(from_zero(key.z)) << 2;
}

constexpr VoxelKey key_of_morton(std::uint64_t code) {
  return {morton_compact(code) + kKeyMin, morton_compact(code >> 1) + kKeyMin,
          morton_compact(code >> 2) + kKeyMin};
}

// Adds up to 8 along each axis. The other axes' bits are set, so that the carry runs over them.
constexpr std::uint64_t morton_add(std::uint64_t code, std::uint32_t x, std::uint32_t y,
                                   std::uint32_t z) {
  constexpr std::array<std::uint64_t, 9> kSpread = {0, 1, 8, 9, 64, 65, 72, 73, 512};
  const auto add = [code](std::size_t axis, std::uint64_t spread) {
    return ((code | ~kMortonAxis[axis]) + (spread << axis)) & kMortonAxis[axis];
  };
  return add(0, kSpread[x]) | add(1, kSpread[y]) | add(2, kSpread[z]);
}

}  // namespace warren
