// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/layer/claim.hpp"
#include "core/layer/code_block.hpp"

namespace warren {

// When the voxels of one block changed last, as a few (revision, mask) groups. Never exact, always
// on the safe side: a voxel's revision here is at least that of its last change, because groups get
// merged as the newer one, and all of them may be dropped.
class ChangeHistory {
 public:
  static constexpr std::size_t kGroups = 8;

  ChangeHistory() = default;  // never changed
  // Any voxel may have changed, up to `latest`.
  explicit ChangeHistory(Revision latest) : latest_(latest) {}

  // Revision of the block's last change.
  Revision latest() const { return latest_; }
  // At least all voxels changed after `from`.
  VoxelMask changed_since(Revision from) const;

  // These voxels changed. Precondition: revision > latest().
  void record(Revision revision, const VoxelMask& changed);
  // Any voxel may have changed. Precondition as above.
  void record_all(Revision revision);
  // Forgets which voxels changed when: gives the memory back.
  void drop() { groups_.reset(); }

  std::size_t heap_bytes() const { return groups_ ? sizeof(Groups) : 0; }

 private:
  // A voxel's group number is spread over three bit-planes. An empty group's revision means
  // nothing.
  struct Groups {
    std::array<VoxelMask, 3> planes{};
    std::array<Revision, kGroups> revisions{};

    VoxelMask voxels_of(std::size_t group) const;
    void move_to(std::size_t group, const VoxelMask& voxels);
    // An empty group; makes one by merging if there is none.
    std::size_t vacate();
  };

  Revision latest_;
  std::unique_ptr<Groups> groups_;  // none: every voxel changed at latest_
};

}  // namespace warren
