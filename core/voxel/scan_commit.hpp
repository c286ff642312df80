// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/voxel/block_store.hpp"
#include "core/voxel/scan_marker.hpp"
#include "core/voxel/sensor_model.hpp"

namespace warren {

struct CommitCounts {
  std::uint64_t voxels_hit = 0;
  std::uint64_t voxels_passed = 0;
  std::uint64_t blocks_changed = 0;
};

// Second step of an integration: adds hit or miss to every marked voxel, clamps, and stamps the
// blocks that changed with `scan`.
CommitCounts commit_marks(const ScanMarker& marker, const FixedSensorModel& model,
                          std::uint32_t scan, BlockStore& store);

}  // namespace warren
