// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/layer/voxel_code.hpp"

namespace warren {

// Which layer is believed where several of others know a voxel.
enum class MergeRule : std::uint8_t {
  kSafest,  // occupied beats free, a higher cost a lower, a cost no data; any stair counts
  kNewest,  // what its origin changed last, by fleet time and block; ties to the lowest LayerId
};

// Neither order nor repetition of its arguments shows in the result.
constexpr VoxelCode safest(VoxelCode a, VoxelCode b) {
  if (a.state() != b.state()) return a.state() > b.state() ? a : b;
  if (a.state() != VoxelState::kOccupied) return a;
  return VoxelCode::occupied(std::max(a.cost(), b.cost()), a.stair() || b.stair());
}

// Whether `code` beats `than` under kSafest, apart from stairs.
constexpr bool is_safer(VoxelCode code, VoxelCode than) {
  return code.state() != than.state() ? code.state() > than.state() : code.cost() > than.cost();
}

}  // namespace warren
