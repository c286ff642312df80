// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/layer/cost_code.hpp"
#include "core/voxel/block_store.hpp"

namespace warren {

// What others get to know of a voxel, in 7 bits (paper Eq. 7-9): 2 of occupancy, 4 of cost, 1 of
// stair. Invariant: only an occupied voxel has a cost or is a stair, so equal codes mean equal
// voxels.
class VoxelCode {
 public:
  static constexpr std::uint8_t kBits = 7;

  constexpr VoxelCode() = default;  // unknown
  static constexpr VoxelCode free() { return VoxelCode{1}; }
  // Precondition: `cost` is a cost code, 0 to 15.
  static constexpr VoxelCode occupied(CostCode cost, bool stair) {
    return VoxelCode{static_cast<std::uint8_t>(2U | (cost & 15U) << 2 | (stair ? 64U : 0U))};
  }

  // Precondition: they are some code's bits().
  static constexpr VoxelCode from_bits(std::uint32_t bits) {
    return VoxelCode{static_cast<std::uint8_t>(bits)};
  }

  constexpr VoxelState state() const { return static_cast<VoxelState>(bits_ & 3); }
  constexpr CostCode cost() const { return bits_ >> 2 & 15; }
  constexpr bool stair() const { return (bits_ & 64) != 0; }
  constexpr std::uint8_t bits() const { return bits_; }

  friend bool operator==(const VoxelCode&, const VoxelCode&) = default;

 private:
  explicit constexpr VoxelCode(std::uint8_t bits) : bits_(bits) {}

  std::uint8_t bits_ = 0;
};

}  // namespace warren
