// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/rivals/changed_voxel.hpp"

namespace warren {

// The octree over changed voxels that the rivals write: a node of level n spans 8^n voxels, the
// root's level is that of OctoMap's, and a voxel's is 0.
inline constexpr int kTreeLevels = 16;

// What a slot of a node says of its child. Three of the numbers are those of VoxelState.
enum class SlotState : std::uint8_t { kUnchanged = 0, kFree = 1, kOccupied = 2, kInner = 3 };

enum class Pruning : std::uint8_t {
  kNone,        // every changed voxel is a leaf of its own
  kEqualCodes,  // a node whose voxels all changed to the same code is one leaf
};

using ChangedVoxels = std::span<const ChangedVoxel>;

constexpr std::uint64_t voxels_of_level(int level) { return std::uint64_t{1} << (3 * level); }

// The voxels below each child of a node.
inline std::array<ChangedVoxels, 8> children_of(ChangedVoxels voxels, int level) {
  std::array<ChangedVoxels, 8> children;
  const int shift = 3 * (level - 1);
  for (std::uint64_t child = 0; child < 8; ++child) {
    const auto in_child = [&](const ChangedVoxel& voxel) {
      return (voxel.morton >> shift & 7) == child;
    };
    const auto end = std::partition_point(voxels.begin(), voxels.end(), in_child);
    const auto count = static_cast<std::size_t>(end - voxels.begin());
    children[child] = voxels.first(count);
    voxels = voxels.subspan(count);
  }
  return children;
}

inline SlotState slot_state(ChangedVoxels child, int child_level, Pruning pruning) {
  if (child.empty()) return SlotState::kUnchanged;
  const auto same = [&](const ChangedVoxel& voxel) { return voxel.code == child[0].code; };
  const bool leaf = child_level == 0 || (pruning == Pruning::kEqualCodes &&
                                         child.size() == voxels_of_level(child_level) &&
                                         std::all_of(child.begin(), child.end(), same));
  return leaf ? static_cast<SlotState>(child[0].code.state()) : SlotState::kInner;
}

// Writes a leaf's voxels out, in Morton order.
inline void add_leaf(std::vector<ChangedVoxel>& voxels, std::uint64_t first_morton, int level,
                     VoxelCode code) {
  for (std::uint64_t i = 0; i < voxels_of_level(level); ++i) {
    voxels.push_back({first_morton + i, code});
  }
}

}  // namespace warren
