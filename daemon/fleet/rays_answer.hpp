// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "core/layer/replica.hpp"
#include "core/voxel/key.hpp"
#include "daemon/control/request.hpp"

namespace warren {

struct RayEnd {
  double range_m = 0.0;  // from the origin to where the ray enters the voxel, or all of its range
  std::optional<VoxelKey> voxel;  // none: nothing stops the ray within its range
  VoxelCode code;                 // of the voxel
};

struct RaysAnswer {
  // Voxels that all rays together are long.
  static constexpr double kVoxelsMax = 131072.0;

  double resolution_m = 0.0;
  Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();  // of key (0, 0, 0)
  std::vector<RayEnd> ends;

  Eigen::Vector3d low_map(const VoxelKey& voxel) const {
    return origin_map + Eigen::Vector3d(voxel.x, voxel.y, voxel.z) * resolution_m;
  }
};

// A map's lattice, and where its key (0, 0, 0) lies in the map frame.
struct RayPlace {
  Lattice lattice;
  Eigen::Vector3d origin_map;
};

// Or why there are none, in words for the client.
using CodeOf = std::function<VoxelCode(const VoxelKey&)>;
tl::expected<RaysAnswer, std::string> cast_rays(const RayPlace& place, const RaysQuestion& question,
                                                const CodeOf& code_of);

// Codes of a layer's voxels for one who goes from each to the next.
class LayerVoxels {
 public:
  // Keeps a reference; nobody else may read or change the layer meanwhile.
  explicit LayerVoxels(const Replica& layer) : layer_(&layer) {}

  VoxelCode operator()(const VoxelKey& key);

 private:
  const Replica* layer_;
  std::optional<BlockOrdinal> block_;
  const CodeBlock* codes_ = nullptr;
};

}  // namespace warren
