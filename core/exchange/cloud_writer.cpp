// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/cloud_writer.hpp"

#include <limits>
#include <string>
#include <vector>

#include "core/exchange/float_rows.hpp"

namespace warren {
namespace {

const std::vector<std::string> kColumns{"x", "y", "z", "p", "cost"};
constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

// x y z p cost of every occupied voxel.
std::vector<float> occupied_rows(const MapSnapshot& map, const LayerOrigin& shift) {
  const double resolution_m = map.voxels.lattice().resolution_m();
  const auto centre = [&](std::int64_t key) {
    return static_cast<float>((static_cast<double>(key) + 0.5) * resolution_m);
  };
  std::vector<float> rows;
  rows.reserve(kColumns.size() * map.voxels.counts().occupied);
  map.voxels.for_each_known_voxel(KeyBox{}, [&](const VoxelKey& key, VoxelState state,
                                                float log_odds) {
    if (state != VoxelState::kOccupied) return;
    rows.insert(rows.end(), {centre(key.x + shift.x), centre(key.y + shift.y),
                             centre(key.z + shift.z), static_cast<float>(probability_of(log_odds)),
                             map.voxels.cost(key).value_or(kNoData)});
  });
  return rows;
}

}  // namespace

WriteResult write_pcd(const MapSnapshot& map, const LayerOrigin& shift,
                      const std::filesystem::path& file) {
  const std::vector<float> rows = occupied_rows(map, shift);
  return write_rows_pcd({kColumns, rows}, file);
}

WriteResult write_ply(const MapSnapshot& map, const LayerOrigin& shift,
                      const std::filesystem::path& file) {
  const std::vector<float> rows = occupied_rows(map, shift);
  return write_rows_ply({kColumns, rows}, file);
}

}  // namespace warren
