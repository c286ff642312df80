// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/layer/code_octree.hpp"
#include "core/layer/merge_map.hpp"
#include "core/voxel/key.hpp"

namespace warren {

// The octree's cubes of 2^level voxels that a box touches.
class CellGrid {
 public:
  // Preconditions: the box lies in the key space and is not empty, level is 0 to
  // CodeOctree::kRootLevel.
  CellGrid(const KeyBox& box, int level);

  int level() const { return level_; }
  std::uint64_t size() const { return count_[0] * count_[1] * count_[2]; }
  // Of cell `index`, x fastest.
  VoxelKey low(std::uint64_t index) const;
  // Precondition: the voxel lies in one of the cells.
  std::uint64_t index_of(const VoxelKey& voxel) const;
  // All voxels of the cells.
  KeyBox voxels() const;

 private:
  int level_;
  VoxelKey first_;  // counted in cells, from the lowest of the key space
  std::array<std::uint64_t, 3> count_{};
};

// One code for each cell, as CodeOctree has it: never better than the worst voxel within.
std::vector<CodeNode> cells_of(const Replica& layer, const CellGrid& grid);
// Derives all that is known within.
std::vector<CodeNode> cells_of(MergeMap& map, const CellGrid& grid);

}  // namespace warren
