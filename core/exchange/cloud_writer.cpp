// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/cloud_writer.hpp"

#include <string>
#include <vector>

#include "core/exchange/float_rows.hpp"

namespace warren {
namespace {

const std::vector<std::string> kColumns{"x", "y", "z", "p", "cost"};

// x y z p cost of every occupied voxel.
std::vector<float> occupied_rows(const ExportedMap& map, const LayerOrigin& shift) {
  const auto centre = [&](std::int64_t key) {
    return static_cast<float>((static_cast<double>(key) + 0.5) * map.resolution_m);
  };
  std::vector<float> rows;
  rows.reserve(kColumns.size() * map.counts.occupied);
  map.for_each_known([&](const ExportedVoxel& voxel) {
    if (voxel.state != VoxelState::kOccupied) return;
    const VoxelKey& key = voxel.key;
    rows.insert(rows.end(),
                {centre(key.x + shift.x), centre(key.y + shift.y), centre(key.z + shift.z),
                 static_cast<float>(probability_of(voxel.log_odds)), voxel.cost});
  });
  return rows;
}

}  // namespace

WriteResult write_pcd(const ExportedMap& map, const LayerOrigin& shift,
                      const std::filesystem::path& file) {
  const std::vector<float> rows = occupied_rows(map, shift);
  return write_rows_pcd({kColumns, rows}, file);
}

WriteResult write_ply(const ExportedMap& map, const LayerOrigin& shift,
                      const std::filesystem::path& file) {
  const std::vector<float> rows = occupied_rows(map, shift);
  return write_rows_ply({kColumns, rows}, file);
}

}  // namespace warren
