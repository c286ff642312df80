// SPDX-License-Identifier: Apache-2.0
#include "core/layer/change_history.hpp"

#include <cassert>
#include <utility>

namespace warren {
namespace {

constexpr VoxelMask all_voxels() {
  VoxelMask mask{};
  mask.fill(kFullCell);
  return mask;
}

}  // namespace

VoxelMask ChangeHistory::changed_since(Revision from) const {
  VoxelMask changed{};
  if (latest_ <= from) return changed;
  if (!groups_) return all_voxels();
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (groups_->revisions[group] <= from) continue;
    const VoxelMask voxels = groups_->voxels_of(group);
    for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) changed[cell] |= voxels[cell];
  }
  return changed;
}

void ChangeHistory::record(Revision revision, const VoxelMask& changed) {
  assert(revision > latest_);
  if (!groups_) {
    groups_ = std::make_unique<Groups>();
    groups_->revisions[0] = latest_;
  }
  const std::size_t group = groups_->vacate();
  groups_->revisions[group] = revision;
  groups_->move_to(group, changed);
  latest_ = revision;
}

void ChangeHistory::record_all(Revision revision) {
  assert(revision > latest_);
  groups_.reset();
  latest_ = revision;
}

VoxelMask ChangeHistory::Groups::voxels_of(std::size_t group) const {
  VoxelMask voxels = all_voxels();
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    const std::uint64_t flip = (group >> plane & 1) != 0 ? 0 : kFullCell;
    for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
      voxels[cell] &= planes[plane][cell] ^ flip;
    }
  }
  return voxels;
}

void ChangeHistory::Groups::move_to(std::size_t group, const VoxelMask& voxels) {
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    const bool ones = (group >> plane & 1) != 0;
    for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
      std::uint64_t& bits = planes[plane][cell];
      bits = ones ? bits | voxels[cell] : bits & ~voxels[cell];
    }
  }
}

std::size_t ChangeHistory::Groups::vacate() {
  std::size_t oldest = kGroups;
  std::size_t second = kGroups;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (!any(voxels_of(group))) return group;
    // What never changed stays apart: merged, it would have to be sent.
    if (revisions[group] == Revision{}) continue;
    if (oldest == kGroups || revisions[group] < revisions[oldest]) {
      second = std::exchange(oldest, group);
    } else if (second == kGroups || revisions[group] < revisions[second]) {
      second = group;
    }
  }
  move_to(second, voxels_of(oldest));
  return oldest;
}

}  // namespace warren
