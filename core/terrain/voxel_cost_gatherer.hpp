// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/terrain/terrain_judge.hpp"
#include "core/terrain/tile_grid.hpp"
#include "core/voxel/key.hpp"
#include "core/voxel/voxel_cost.hpp"

namespace warren {

// One cost per voxel from the judged points of one scan: their mean. They come from a reduced
// cloud, so that neither density nor order of the scan's points counts. Reuses buffers.
class VoxelCostGatherer {
 public:
  // At this range a scan tells half of what it would from close by: noise and the width of
  // neighbourhoods grow with range.
  static constexpr float kHalfInformationRange_m = 5.0F;

  // Points without a cost say nothing. Lives until the next call.
  std::span<const VoxelCost> gather(std::span<const JudgedPoint> points,
                                    const Point3f& origin_layer, const Lattice& lattice);

 private:
  struct Sum {
    float cost = 0.0F;
    std::uint32_t points = 0;
  };
  std::uint32_t number_of(const VoxelKey& key);

  TileTable numbers_;  // packed key to a place in costs_
  std::uint64_t last_code_ = 0;
  std::uint32_t last_number_ = 0;
  std::vector<Sum> sums_;
  std::vector<VoxelCost> costs_;
};

}  // namespace warren
