// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "core/voxel/key.hpp"

namespace warren {

// Blocks within the key space, both corners belong to it. Empty if a low coordinate exceeds the
// high one.
struct BlockBox {
  BlockKey low;
  BlockKey high;
  bool clipped = false;  // a part lay outside the key space

  std::size_t size() const;
  // Place of a block in the box, x fastest; nothing when it is outside.
  std::optional<std::size_t> index_of(const BlockKey& key) const;

  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (std::int32_t z = low.z; z <= high.z; ++z) {
      for (std::int32_t y = low.y; y <= high.y; ++y) {
        for (std::int32_t x = low.x; x <= high.x; ++x) visit(BlockKey{x, y, z});
      }
    }
  }
};

// Where a layer lies in the merge-map: which voxels of the one are which of the other. A pose that
// is a shift by whole voxels, to a millionth, is taken as exactly that.
class MergePlacement {
 public:
  static constexpr double kFarthest_m = 1e9;
  static constexpr double kResolutionRatioMax = 8.0;

  // Whether layers of this resolution can be merged: at most kResolutionRatioMax times finer or
  // coarser.
  static bool is_resolution_near(double layer_resolution_m, double merge_resolution_m);
  // Nothing when the pose is not finite, not rigid or farther than kFarthest_m. Precondition: the
  // resolutions are near.
  static std::optional<MergePlacement> at(const Eigen::Isometry3d& T_merge_layer,
                                          double layer_resolution_m, double merge_resolution_m);

  bool is_shift() const { return shift_.has_value(); }
  // Merge-map's key less the layer's. Precondition: is_shift().
  const std::array<std::int64_t, 3>& shift() const { return *shift_; }

  // The voxel that the centre of a voxel lies in; nothing outside the key space.
  std::optional<VoxelKey> to_merge(const VoxelKey& layer) const;
  std::optional<VoxelKey> to_layer(const VoxelKey& merge) const;

  // At least all blocks whose content may depend on the other's block.
  BlockBox blocks_in_merge(const BlockKey& layer) const;
  BlockBox blocks_in_layer(const BlockKey& merge) const;

 private:
  // From voxels to voxels.
  struct Map {
    Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  };

  static std::optional<VoxelKey> through(const Map& map, const VoxelKey& key);
  static BlockBox box_through(const Map& map, const BlockKey& key);
  static BlockBox shifted(const BlockKey& key, const std::array<std::int64_t, 3>& shift, int sign);

  Map to_merge_;
  Map to_layer_;
  std::optional<std::array<std::int64_t, 3>> shift_;
};

}  // namespace warren
