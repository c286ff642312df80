// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "core/exchange/map_snapshot.hpp"
#include "core/layer/replica.hpp"

namespace warren {

struct ExportedVoxel {
  VoxelKey key;
  VoxelState state = VoxelState::kUnknown;
  float log_odds = 0.0F;
  float cost = 0.0F;  // of an occupied voxel; NaN without data
};

// What the writers of trees and clouds need of a map: a robot's own, or a layer. Valid as long as
// what it was made of is and stays unchanged.
struct ExportedMap {
  using Visit = std::function<void(const ExportedVoxel&)>;

  double resolution_m = 0.0;
  SensorModel sensor_model;
  MapCounts counts;
  std::function<void(const Visit&)> for_each_known;
};

ExportedMap exported(const MapSnapshot& map);
// Occupied and free voxels have the log-odds that OctoMap clamps at by default.
ExportedMap exported(const Replica& layer);

}  // namespace warren
