// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/block_state.hpp"

#include <algorithm>
#include <bit>

namespace warren {
namespace {

bool has_key(const BlockKey& key) {
  const auto [low, high] = std::minmax({key.x, key.y, key.z});
  return kKeyMin / kBlockEdge <= low && high <= kKeyMax / kBlockEdge;
}

}  // namespace

bool BlockState::is_sound() const {
  std::size_t values_needed = 0;
  std::size_t costs_needed = 0;
  std::uint64_t any = 0;
  std::uint64_t misplaced = 0;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    any |= known[cell];
    misplaced |= (occupied[cell] | clamped_free[cell]) & ~known[cell];
    misplaced |= occupied[cell] & clamped_free[cell];
    misplaced |= costed[cell] & ~stored(cell);
    values_needed += static_cast<std::size_t>(std::popcount(stored(cell)));
    costs_needed += static_cast<std::size_t>(std::popcount(costed[cell]));
  }
  return any != 0 && misplaced == 0 && values.size() == values_needed &&
         costs.size() == costs_needed && changed_at != 0 && has_key(key);
}

}  // namespace warren
