// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/exported_map.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace warren {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

float log_odds_of(double probability) {
  return static_cast<float>(std::log(probability / (1.0 - probability)));
}

MapCounts counts_of(const Replica& layer) {
  MapCounts counts;
  layer.for_each_changed({}, {}, [&](BlockOrdinal, const LayerBlock& block) {
    for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
      const auto occupied = static_cast<unsigned>(std::popcount(block.codes.occupied()[cell]));
      counts.occupied += occupied;
      counts.free += static_cast<unsigned>(std::popcount(block.codes.known()[cell])) - occupied;
    }
    counts.blocks += block.codes.empty() ? 0 : 1;
    return true;
  });
  return counts;
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
                  visit({key, state, log_odds, cost});
                });
          }};
}

ExportedMap exported(const Replica& layer) {
  const SensorModel model = SensorModel::octomap_default();
  const float free = log_odds_of(model.minimum);
  const float occupied = log_odds_of(model.maximum);
  return {layer.resolution().metres(), model, counts_of(layer),
          [&layer, free, occupied](const ExportedMap::Visit& visit) {
            layer.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
              found.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
                const bool is_occupied = code.state() == VoxelState::kOccupied;
                visit({key_of_morton(block << 9 | place), code.state(),
                       is_occupied ? occupied : free, decode_cost(code.cost()).value_or(kNoData)});
              });
              return true;
            });
          }};
}

}  // namespace warren
