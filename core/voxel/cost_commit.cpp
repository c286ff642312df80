// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/cost_commit.hpp"

namespace warren {
namespace {

// Finds the blocks of voxels that come in runs.
class BlockFinder {
 public:
  explicit BlockFinder(BlockStore& store) : store_(store) {}

  // Null when no block is held there.
  Block* find(const BlockKey& key) {
    if (key_ != key) {
      key_ = key;
      region_ = store_.find_region({key.x >> 3, key.y >> 3, key.z >> 3});
      slot_ = region_ == BlockStore::kNoRegion ? kAbsentBlock
                                               : store_.region(region_).slots[slot_in_region(key)];
    }
    return slot_ < kFirstBlockSlot ? nullptr : &store_.block(slot_);
  }
  // The block found last.
  void stamp(std::uint32_t scan) { store_.mark_changed(region_, slot_in_region(key_), scan); }

 private:
  BlockStore& store_;
  BlockKey key_{kKeyMin, kKeyMin, kKeyMin};  // no block's
  std::uint32_t region_ = BlockStore::kNoRegion;
  BlockSlot slot_ = kAbsentBlock;
};

}  // namespace

CostFusionReport commit_costs(std::span<const VoxelCost> costs, const CostFusion& fusion,
                              const FixedSensorModel& model, std::uint32_t scan,
                              BlockStore& store) {
  CostFusionReport report;
  BlockFinder finder(store);
  for (const VoxelCost& measured : costs) {
    Block* const block = finder.find(block_of(measured.key));
    const std::uint32_t place = morton9(measured.key.x, measured.key.y, measured.key.z);
    const std::size_t cell = place >> 6;
    if (block == nullptr || (block->stored(cell) >> (place & 63) & 1) == 0) {
      ++report.voxels_without_hit;
      continue;
    }
    const auto before = store.cost(*block, place);
    double occupancy = 0.0;
    if (before && fusion.weighs_occupancy()) {
      occupancy = probability_of(model.log_odds(
          store.values().value(block->values[cell], block->stored(cell), place & 63)));
    }
    const FusedCost after =
        before ? fusion.next(*before, measured, occupancy) : fusion.first(measured);
    ++report.voxels_fused;
    if (before == after) continue;
    store.set_cost(*block, place, after);
    if (before && before->cost == after.cost) continue;
    finder.stamp(scan);
    ++report.voxels_changed;
  }
  return report;
}

}  // namespace warren
