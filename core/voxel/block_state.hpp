// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/voxel/block_store.hpp"
#include "core/voxel/key.hpp"
#include "core/voxel/voxel_cost.hpp"

namespace warren {

// All that a self-map knows of one block, to the bit: what a store keeps. Cells and bits in Morton
// order.
struct BlockState {
  using Mask = std::array<std::uint64_t, kCellsPerBlock>;

  BlockKey key;
  std::uint32_t changed_at = 0;  // number of a scan
  Mask known{};
  Mask occupied{};
  Mask clamped_free{};
  Mask costed{};
  std::vector<std::int16_t> values;  // fixed-point log-odds of those known and not clamped_free
  std::vector<FusedCost> costs;      // of those costed

  std::uint64_t stored(std::size_t cell) const { return known[cell] & ~clamped_free[cell]; }
  // Whether it keeps the invariants of Block and BlockCosts, with as many numbers as voxels that
  // need one, and has a key and a scan. What the numbers may be is the sensor model's affair.
  bool is_sound() const;

  friend bool operator==(const BlockState&, const BlockState&) = default;
};

}  // namespace warren
