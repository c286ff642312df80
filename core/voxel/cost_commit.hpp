// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/voxel/block_store.hpp"
#include "core/voxel/sensor_model.hpp"
#include "core/voxel/voxel_cost.hpp"

namespace warren {

struct CostFusionReport {
  std::uint64_t voxels_fused = 0;
  std::uint64_t voxels_changed = 0;
  std::uint64_t voxels_without_hit = 0;  // nothing is stored there that could carry a cost
};

// Fuses one scan's costs, at most one per voxel, after its marks are committed; stamps the blocks
// that changed with `scan`.
CostFusionReport commit_costs(std::span<const VoxelCost> costs, const CostFusion& fusion,
                              const FixedSensorModel& model, std::uint32_t scan, BlockStore& store);

}  // namespace warren
