// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/exported_map.hpp"

#include <cmath>
#include <limits>

#include "core/layer/layer_counts.hpp"

namespace warren {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

float log_odds_of(double probability) {
  return static_cast<float>(std::log(probability / (1.0 - probability)));
}

ExportedVoxel voxel_of(const VoxelKey& key, VoxelCode code, SourceNumber source) {
  static const float free = log_odds_of(SensorModel::octomap_default().minimum);
  static const float occupied = log_odds_of(SensorModel::octomap_default().maximum);
  const bool is_occupied = code.state() == VoxelState::kOccupied;
  return {key, code.state(), is_occupied ? occupied : free,
          decode_cost(code.cost()).value_or(kNoData), source};
}

}  // namespace

ExportedMap exported(const MapSnapshot& map) {
  const SelfMap& voxels = map.voxels;
  return {voxels.lattice().resolution_m(), voxels.config().sensor_model, voxels.counts(),
          [&voxels](const ExportedMap::Visit& visit) {
            voxels.for_each_known_voxel(
                KeyBox{}, [&](const VoxelKey& key, VoxelState state, float log_odds) {
                  const bool occupied = state == VoxelState::kOccupied;
                  const float cost = occupied ? voxels.cost(key).value_or(kNoData) : kNoData;
                  visit({key, state, log_odds, cost, 0});
                });
          }};
}

ExportedMap exported(const Replica& layer) {
  return {layer.resolution().metres(), SensorModel::octomap_default(), counts_of(layer),
          [&layer](const ExportedMap::Visit& visit) {
            layer.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
              found.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
                visit(voxel_of(key_of_morton(block << 9 | place), code, 0));
              });
              return true;
            });
          }};
}

ExportedMap exported(const MergedSnapshot& map) {
  return {map.resolution_m(),
          SensorModel::octomap_default(),
          map.counts(),
          [&map](const ExportedMap::Visit& visit) {
            map.for_each_known([&](const VoxelKey& key, VoxelCode code, SourceNumber source) {
              visit(voxel_of(key, code, source));
            });
          },
          map.others(),
          map.other_names()};
}

}  // namespace warren
