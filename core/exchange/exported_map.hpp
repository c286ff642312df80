// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/exchange/map_snapshot.hpp"
#include "core/exchange/merged_snapshot.hpp"
#include "core/layer/replica.hpp"

namespace warren {

struct ExportedVoxel {
  VoxelKey key;
  VoxelState state = VoxelState::kUnknown;
  float log_odds = 0.0F;
  float cost = 0.0F;  // of an occupied voxel; NaN without data
  SourceNumber source = 0;
};

// What the writers of trees and clouds need of a map: a robot's own, or a layer. Valid as long as
// what it was made of is and stays unchanged.
struct ExportedMap {
  using Visit = std::function<void(const ExportedVoxel&)>;

  double resolution_m = 0.0;
  SensorModel sensor_model;
  MapCounts counts;
  std::function<void(const Visit&)> for_each_known;
  // Whose voxels have the source numbers from 1 on; nothing where voxels have no source.
  std::optional<std::vector<LayerId>> others = std::nullopt;
  std::vector<std::string> other_names = {};  // of the nodes that made them
};

ExportedMap exported(const MapSnapshot& map);
// Of these two, occupied and free voxels have the log-odds that OctoMap clamps at by default.
ExportedMap exported(const Replica& layer);
ExportedMap exported(const MergedSnapshot& map);

}  // namespace warren
