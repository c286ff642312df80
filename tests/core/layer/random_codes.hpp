// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "core/layer/code_block.hpp"

namespace warren::test {

using Random = std::mt19937_64;

inline std::uint32_t below(Random& random, std::uint32_t end) {
  return static_cast<std::uint32_t>(random() % end);
}
inline bool chance(Random& random, std::uint32_t percent) { return below(random, 100) < percent; }

inline VoxelCode random_code(Random& random) {
  const std::uint32_t state = below(random, 3);
  if (state == 0) return {};
  if (state == 1) return VoxelCode::free();
  const auto cost = static_cast<CostCode>(below(random, 16));
  const bool stair = chance(random, 20);
  return VoxelCode::occupied(cost, stair);
}

// Noise: every voxel on its own.
inline BlockCodes random_codes(Random& random, std::uint32_t percent = 100) {
  BlockCodes codes;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    if (chance(random, percent)) codes.set(place, random_code(random));
  }
  return codes;
}

inline VoxelMask random_mask(Random& random) {
  VoxelMask mask{};
  for (std::uint32_t count = below(random, kVoxelsPerBlock / 4); count > 0; --count) {
    insert(mask, below(random, kVoxelsPerBlock));
  }
  return mask;
}

}  // namespace warren::test
