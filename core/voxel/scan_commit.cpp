// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/scan_commit.hpp"

#include <algorithm>
#include <bit>

#include "core/voxel/bits.hpp"

namespace warren {
namespace {

struct CellMarks {
  std::uint64_t hit = 0;
  std::uint64_t pass = 0;
};

// Whether any value of the cell changed.
bool commit_cell(Block& block, std::size_t cell, const CellMarks& marks,
                 const FixedSensorModel& model, LogOddsCells& store) {
  std::array<std::int16_t, 64> values{};
  store.unpack(block.values[cell], block.stored(cell), values);
  // Values of voxels at the clamp are not stored; only a hit can move them.
  for_each_bit(marks.hit & block.clamped_free[cell],
               [&](std::uint32_t bit) { values[bit] = model.minimum; });

  std::uint64_t changed = (marks.hit | marks.pass) & ~block.known[cell];
  std::uint64_t occupied = block.occupied[cell];
  std::uint64_t clamped = block.clamped_free[cell] & ~marks.hit;
  for_each_bit(marks.pass, [&](std::uint32_t bit) {
    const std::uint64_t mask = std::uint64_t{1} << bit;
    const int moved = std::max<int>(values[bit] + model.miss, model.minimum);
    values[bit] = static_cast<std::int16_t>(moved);
    changed |= mask;
    occupied = moved >= 0 ? occupied | mask : occupied & ~mask;
    if (moved == model.minimum) clamped |= mask;
  });
  for_each_bit(marks.hit, [&](std::uint32_t bit) {
    const std::uint64_t mask = std::uint64_t{1} << bit;
    const int moved = std::min<int>(values[bit] + model.hit, model.maximum);
    if (moved != values[bit]) changed |= mask;
    values[bit] = static_cast<std::int16_t>(moved);
    occupied = moved >= 0 ? occupied | mask : occupied & ~mask;
  });
  if (changed == 0) return false;

  block.known[cell] |= marks.hit | marks.pass;
  block.occupied[cell] = occupied;
  block.clamped_free[cell] = clamped;
  block.values[cell] = store.repack(block.values[cell], block.stored(cell), values);
  return true;
}

}  // namespace

CommitCounts commit_marks(const ScanMarker& marker, const FixedSensorModel& model,
                          std::uint32_t scan, BlockStore& store) {
  CommitCounts counts;
  for (std::uint32_t i = 0; i < marker.marked_count(); ++i) {
    const MarkedBlock& marked = marker.marked(i);
    const BlockMask& hits = marker.hits(marked);
    BlockSlot& slot = store.region(marked.region).slots[marked.slot];
    Block& block = store.materialise(slot);
    bool changed = false;
    for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
      const CellMarks marks{hits[cell],
                            marked.done[cell] & ~hits[cell] & ~block.clamped_free[cell]};
      if ((marks.hit | marks.pass) == 0) continue;
      counts.voxels_hit += static_cast<std::uint64_t>(std::popcount(marks.hit));
      counts.voxels_passed += static_cast<std::uint64_t>(std::popcount(marks.pass));
      changed |= commit_cell(block, cell, marks, model, store.values());
    }
    store.forget_costs_at_clamp(block);
    store.collapse_if_free(slot);
    if (!changed) continue;
    store.mark_changed(marked.region, marked.slot, scan);
    ++counts.blocks_changed;
  }
  return counts;
}

}  // namespace warren
