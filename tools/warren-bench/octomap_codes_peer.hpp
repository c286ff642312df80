// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "tools/rivals/changed_voxel.hpp"

namespace warren {

// Debian's OctoMap as a receiver of diff-maps: each changed voxel's occupancy is set, in the order
// that suits its tree best. Costs and stairs are spared it.
class OctomapCodesPeer {
 public:
  OctomapCodesPeer(double resolution_m, bool lazy_eval);
  ~OctomapCodesPeer();

  void insert(std::span<const ChangedVoxel> voxels);
  // Brings inner nodes up to date and prunes: the part of the work that lazy_eval puts off.
  void finish();

  VoxelState search(const VoxelKey& key) const;
  // The states at these points. Precondition: as many as there are points.
  void search(std::span<const Point3f> points, std::span<VoxelState> states) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
  bool lazy_eval_;
};

}  // namespace warren
