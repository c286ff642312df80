// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/scan_marker.hpp"

#include <algorithm>

namespace warren {
namespace {

std::uint32_t slot_of(std::uint64_t code) { return static_cast<std::uint32_t>(code >> 9 & 511); }

bool all_done(const BlockMask& done) {
  std::uint64_t all = kFullCell;
  for (const std::uint64_t mask : done) all &= mask;
  return all == kFullCell;
}

}  // namespace

void ScanMarker::begin(BlockStore& store) {
  store_ = &store;
  for (std::uint32_t i = 0; i < regions_used_; ++i) region_numbers_[regions_[i]->index] = 0;
  regions_used_ = 0;
  current_ = nullptr;
  current_code_ = kNoRegion;
  marked_.clear();
  hits_.clear();
}

void ScanMarker::hit(const VoxelKey& key) {
  const std::uint64_t code = morton_of(key);
  Entry& entry = enter_block(code);
  if ((entry & ~kAllDone) == 0) entry |= add_marked(current_->index, slot_of(code));
  MarkedBlock& block = marked_[(entry & ~kAllDone) - 1];
  if (block.hits == MarkedBlock::kNoHits) block.hits = hits_.allocate();
  const std::uint64_t bit = std::uint64_t{1} << (code & 63);
  hits_[block.hits][code >> 6 & 7] |= bit;
  block.done[code >> 6 & 7] |= bit;
}

void ScanMarker::pass(RayWalker walker) {
  bool more = walker.remaining > 0;
  while (more) {
    Entry& entry = enter_block(walker.code());
    more = (entry & kAllDone) != 0 ? walker.leave_cube<3>()
                                   : walk_block(walker, marked_[entry - 1].done, entry);
  }
}

// Marks the walker's voxels up to where it leaves the block; false when it ends before.
bool ScanMarker::walk_block(RayWalker& outside, BlockMask& done, Entry& entry) {
  RayWalker walker = outside;  // in registers: the masks could alias the original
  const std::uint64_t block = walker.mirrored >> 9;
  bool skipped = false;
  do {
    const std::uint64_t code = walker.code();
    std::uint64_t& cell = done[code >> 6 & 7];
    if (cell == kFullCell) {
      skipped = true;
      walker.leave_cube<2>();
    } else {
      cell |= std::uint64_t{1} << (code & 63);
      walker.advance();
    }
  } while (walker.remaining > 0 && walker.mirrored >> 9 == block);
  // A block is full only if its last cell is; looking when a full cell was met is soon enough.
  if (skipped && all_done(done)) entry |= kAllDone;
  outside = walker;
  return walker.remaining > 0;
}

ScanMarker::Entry& ScanMarker::enter_block(std::uint64_t code) {
  if (code >> 18 != current_code_) enter_region(code);
  Entry& entry = current_->entries[slot_of(code)];
  if (entry == 0) entry = first_entry(current_->index, slot_of(code));
  return entry;
}

void ScanMarker::enter_region(std::uint64_t code) {
  const std::uint32_t index = store_->find_or_add_region(region_of(key_of_morton(code)));
  if (index >= region_numbers_.size()) region_numbers_.resize(index + 1, 0);
  if (region_numbers_[index] == 0) {
    if (regions_used_ == regions_.size()) regions_.push_back(std::make_unique<ScanRegion>());
    ScanRegion& fresh = *regions_[regions_used_++];
    fresh.index = index;
    fresh.entries.fill(0);
    region_numbers_[index] = regions_used_;
  }
  current_ = regions_[region_numbers_[index] - 1].get();
  current_code_ = code >> 18;
}

ScanMarker::Entry ScanMarker::first_entry(std::uint32_t region, std::uint32_t slot) {
  if (store_->region(region).slots[slot] == kFreeBlock) return kAllDone;
  return add_marked(region, slot);
}

ScanMarker::Entry ScanMarker::add_marked(std::uint32_t region, std::uint32_t slot) {
  const std::uint32_t index = marked_.allocate();
  MarkedBlock& block = marked_[index];
  block.region = region;
  block.slot = slot;
  const BlockSlot held = store_->region(region).slots[slot];
  if (held == kFreeBlock) block.done.fill(kFullCell);
  if (held >= kFirstBlockSlot) block.done = store_->block(held).clamped_free;
  return index + 1;
}

std::size_t ScanMarker::memory_bytes() const {
  return regions_.size() * sizeof(ScanRegion) + regions_.capacity() * sizeof(regions_[0]) +
         region_numbers_.capacity() * sizeof(std::uint32_t) + marked_.memory_bytes() +
         hits_.memory_bytes();
}

}  // namespace warren
