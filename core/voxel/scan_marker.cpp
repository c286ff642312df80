// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/scan_marker.hpp"

#include <algorithm>

namespace warren {
namespace {

bool all_done(const BlockMask& done) {
  std::uint64_t all = kFullCell;
  for (const std::uint64_t mask : done) all &= mask;
  return all == kFullCell;
}

// Whether two keys lie in the same aligned cube of 2^kLevel voxels.
template <int kLevel>
bool same_cube(const std::array<std::int32_t, 3>& a, const std::array<std::int32_t, 3>& b) {
  return (((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) >> kLevel) == 0;
}

// Marks the walker's voxels up to where it leaves the cell or ends.
std::uint64_t walk_cell(RayWalker& walker, std::uint64_t done) {
  const std::array<std::int32_t, 3> entered = walker.key;
  do {
    const std::uint32_t place = morton9(walker.key[0], walker.key[1], walker.key[2]);
    done |= std::uint64_t{1} << (place & 63);
    walker.advance();
  } while (walker.remaining > 0 && same_cube<2>(walker.key, entered));
  return done;
}

}  // namespace

void ScanMarker::begin(BlockStore& store) {
  store_ = &store;
  for (std::uint32_t i = 0; i < regions_used_; ++i) region_numbers_[regions_[i]->index] = 0;
  regions_used_ = 0;
  current_ = nullptr;
  marked_.clear();
  hits_.clear();
}

void ScanMarker::hit(const VoxelKey& key) {
  Entry& entry = enter_block({key.x, key.y, key.z});
  const std::uint32_t slot = slot_in_region(block_of(key));
  if ((entry & ~kAllDone) == 0) entry |= add_marked(current_->index, slot);
  MarkedBlock& block = marked_[(entry & ~kAllDone) - 1];
  if (block.hits == MarkedBlock::kNoHits) block.hits = hits_.allocate();
  const std::uint32_t place = morton9(key.x, key.y, key.z);
  const std::uint64_t bit = std::uint64_t{1} << (place & 63);
  hits_[block.hits][place >> 6] |= bit;
  block.done[place >> 6] |= bit;
}

void ScanMarker::pass(RayWalker walker) {
  bool more = walker.remaining > 0;
  while (more) {
    Entry& entry = enter_block(walker.key);
    more = (entry & kAllDone) != 0 ? walker.leave_cube<8>()
                                   : walk_block(walker, marked_[entry - 1], entry);
  }
}

bool ScanMarker::walk_block(RayWalker& walker, MarkedBlock& block, Entry& entry) {
  const std::array<std::int32_t, 3> entered = walker.key;
  do {
    const std::uint32_t cell = morton9(walker.key[0], walker.key[1], walker.key[2]) >> 6;
    if (block.done[cell] == kFullCell) {
      if (!walker.leave_cube<4>()) return false;
      continue;
    }
    block.done[cell] = walk_cell(walker, block.done[cell]);
    if (block.done[cell] == kFullCell && all_done(block.done)) entry |= kAllDone;
    if (walker.remaining <= 0) return false;
  } while (same_cube<3>(walker.key, entered));
  return true;
}

ScanMarker::ScanRegion& ScanMarker::enter_region(const VoxelKey& region) {
  if (current_ != nullptr && current_key_ == region) return *current_;
  const std::uint32_t index = store_->find_or_add_region(region);
  if (index >= region_numbers_.size()) region_numbers_.resize(index + 1, 0);
  if (region_numbers_[index] == 0) {
    if (regions_used_ == regions_.size()) regions_.push_back(std::make_unique<ScanRegion>());
    ScanRegion& fresh = *regions_[regions_used_++];
    fresh.index = index;
    fresh.entries.fill(0);
    region_numbers_[index] = regions_used_;
  }
  current_ = regions_[region_numbers_[index] - 1].get();
  current_key_ = region;
  return *current_;
}

ScanMarker::Entry& ScanMarker::enter_block(const std::array<std::int32_t, 3>& key) {
  ScanRegion& region = enter_region(region_of({key[0], key[1], key[2]}));
  const std::uint32_t slot = morton9(key[0] >> 3, key[1] >> 3, key[2] >> 3);
  Entry& entry = region.entries[slot];
  if (entry == 0) entry = first_entry(region.index, slot);
  return entry;
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
