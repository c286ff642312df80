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
  cache_.fill({});
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

void ScanMarker::pass(RayPath& path, RayWalker walker) {
  // What is near the sensor is mostly done: the voxels of those blocks are not even counted out.
  while (walker.remaining > 0 && (enter_block(walker.code()) & kAllDone) != 0) {
    if (!walker.leave_block()) return;
  }
  if (walker.remaining > 0) mark_voxels(walker.code(), path.unroll(walker));
}

void ScanMarker::mark_voxels(std::uint64_t code, std::span<const std::uint64_t> steps) {
  const std::uint64_t* step = steps.data();
  const std::uint64_t* const end = step + steps.size();
  while (step != end) {
    Entry& entry = enter_block(code);
    const std::uint64_t block = code >> 9;
    if ((entry & kAllDone) != 0) {
      do {
        code ^= *step++;
      } while (code >> 9 == block);
      continue;
    }
    BlockMask& done = marked_[entry - 1].done;
    do {  // the last step leaves every block
      done[code >> 6 & 7] |= std::uint64_t{1} << (code & 63);
      code ^= *step++;
    } while (code >> 9 == block);
    if (all_done(done)) entry |= kAllDone;
  }
}

ScanMarker::Entry& ScanMarker::enter_block(std::uint64_t code) {
  if (code >> 18 != current_code_) enter_region(code >> 18);
  Entry& entry = current_->entries[slot_of(code)];
  if (entry == 0) entry = first_entry(current_->index, slot_of(code));
  return entry;
}

void ScanMarker::enter_region(std::uint64_t region_code) {
  CachedRegion& cached = cache_[region_code % cache_.size()];
  if (cached.code != region_code) cached = {region_code, &find_region(region_code)};
  current_ = cached.region;
  current_code_ = region_code;
}

ScanMarker::ScanRegion& ScanMarker::find_region(std::uint64_t region_code) {
  const std::uint32_t index =
      store_->find_or_add_region(region_of(key_of_morton(region_code << 18)));
  if (index >= region_numbers_.size()) region_numbers_.resize(index + 1, 0);
  if (region_numbers_[index] == 0) {
    if (regions_used_ == regions_.size()) regions_.push_back(std::make_unique<ScanRegion>());
    ScanRegion& fresh = *regions_[regions_used_++];
    fresh.index = index;
    fresh.entries.fill(0);
    region_numbers_[index] = regions_used_;
  }
  return *regions_[region_numbers_[index] - 1];
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
