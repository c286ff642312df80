// SPDX-License-Identifier: Apache-2.0
#include "core/layer/code_cells.hpp"

#include <cassert>

namespace warren {
namespace {

std::int32_t cell_of(std::int32_t key, int level) { return (key - kKeyMin) >> level; }
std::int32_t low_key_of(std::int32_t cell, int level) { return (cell << level) + kKeyMin; }

}  // namespace

CellGrid::CellGrid(const KeyBox& box, int level)
    : level_(level),
      first_{cell_of(box.low.x, level), cell_of(box.low.y, level), cell_of(box.low.z, level)} {
  assert(level >= 0 && level <= CodeOctree::kRootLevel);
  assert(KeyBox{}.contains(box.low) && KeyBox{}.contains(box.high));
  const auto count = [&](std::int32_t high, std::int32_t first) {
    assert(cell_of(high, level) >= first);
    return static_cast<std::uint64_t>(cell_of(high, level) - first) + 1;
  };
  count_ = {count(box.high.x, first_.x), count(box.high.y, first_.y), count(box.high.z, first_.z)};
}

VoxelKey CellGrid::low(std::uint64_t index) const {
  const auto key = [&](std::int32_t first, std::uint64_t step) {
    return low_key_of(first + static_cast<std::int32_t>(step), level_);
  };
  return {key(first_.x, index % count_[0]), key(first_.y, index / count_[0] % count_[1]),
          key(first_.z, index / count_[0] / count_[1])};
}

std::uint64_t CellGrid::index_of(const VoxelKey& voxel) const {
  const auto step = [&](std::int32_t key, std::int32_t first) {
    return static_cast<std::uint64_t>(cell_of(key, level_) - first);
  };
  return (step(voxel.z, first_.z) * count_[1] + step(voxel.y, first_.y)) * count_[0] +
         step(voxel.x, first_.x);
}

KeyBox CellGrid::voxels() const {
  const VoxelKey last = low(size() - 1);
  const std::int32_t edge = 1 << level_;
  return {low(0), {last.x + edge - 1, last.y + edge - 1, last.z + edge - 1}};
}

std::vector<CodeNode> cells_of(const Replica& layer, const CellGrid& grid) {
  const CodeOctree octree(layer);
  std::vector<CodeNode> cells;
  cells.reserve(grid.size());
  for (std::uint64_t i = 0; i < grid.size(); ++i) {
    cells.push_back(octree.node(grid.low(i), grid.level()));
  }
  return cells;
}

std::vector<CodeNode> cells_of(MergeMap& map, const CellGrid& grid) {
  struct Known {
    CodeMix mix;
    std::uint64_t voxels = 0;
  };
  std::vector<Known> known(grid.size());
  map.for_each_known_voxel(grid.voxels(), [&](const VoxelKey& key, const MergedVoxel& voxel) {
    Known& cell = known[grid.index_of(key)];
    cell.mix |= CodeMix(voxel.code);
    ++cell.voxels;
  });
  std::vector<CodeNode> cells;
  cells.reserve(grid.size());
  const std::uint64_t whole = std::uint64_t{1} << 3 * grid.level();
  for (std::uint64_t i = 0; i < grid.size(); ++i) {
    if (known[i].voxels < whole) known[i].mix |= CodeMix(VoxelCode{});
    cells.push_back(CodeNode::of(grid.low(i), grid.level(), known[i].mix));
  }
  return cells;
}

}  // namespace warren
