// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>

#include <Eigen/Geometry>

#include "tools/world/truth/sight.hpp"

namespace warren::world {

enum class VoxelTruth : std::uint8_t {
  kUnseen,   // nobody could know
  kFree,     // no surface in it, and its centre was in sight
  kSurface,  // a triangle touches it
};

// The truth about space on the lattice of multiples of the resolution, as maps use it: voxel (x, y,
// z) spans [x, x + 1) times the resolution, and so on.
class VoxelLabels {
 public:
  using Index = Eigen::Vector3i;

  // Surfaces alone. Indices must lie within +-2^20.
  VoxelLabels(const TriangleMesh& mesh, double resolution_m);

  // Spreads from the viewpoints through neighbouring voxels whose centres are in sight: air seen
  // only through a hole that no such centre lies in is missed.
  void add_free(const Sight& sight, std::span<const Eigen::Isometry3d> viewpoints);

  VoxelTruth at(const Index& index) const;
  Index index_of(const Eigen::Vector3d& position) const;
  Eigen::Vector3d centre_of(const Index& index) const;
  std::size_t count(VoxelTruth label) const;  // not of the unseen: they are endless

 private:
  using Key = std::uint64_t;
  static Key key_of(const Index& index);
  void add_surface(const std::array<Eigen::Vector3d, 3>& triangle);

  double resolution_m_;
  std::unordered_map<Key, VoxelTruth> labels_;
};

}  // namespace warren::world
