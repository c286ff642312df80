// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/cloud_writer.hpp"

#include <bit>
#include <string>
#include <vector>

#include "core/exchange/float_rows.hpp"
#include "core/exchange/source_legend.hpp"

namespace warren {
namespace {

// A map whose voxels have a source tells it, too, in the last two columns.
constexpr std::size_t kColumns = 5;
const std::vector<std::string> kNames{"x", "y", "z", "p", "cost", "source", "rgb"};
const std::vector<ColumnType> kTypes{ColumnType::kFloat, ColumnType::kFloat, ColumnType::kFloat,
                                     ColumnType::kFloat, ColumnType::kFloat, ColumnType::kCount,
                                     ColumnType::kColour};

// The columns of every occupied voxel.
std::vector<float> occupied_values(const ExportedMap& map, const LayerOrigin& shift) {
  const auto centre = [&](std::int64_t key) {
    return static_cast<float>((static_cast<double>(key) + 0.5) * map.resolution_m);
  };
  std::vector<float> values;
  values.reserve((map.others ? kNames.size() : kColumns) * map.counts.occupied);
  map.for_each_known([&](const ExportedVoxel& voxel) {
    if (voxel.state != VoxelState::kOccupied) return;
    const VoxelKey& key = voxel.key;
    values.insert(values.end(),
                  {centre(key.x + shift.x), centre(key.y + shift.y), centre(key.z + shift.z),
                   static_cast<float>(probability_of(voxel.log_odds)), voxel.cost});
    if (!map.others) return;
    values.push_back(std::bit_cast<float>(std::uint32_t{voxel.source}));
    values.push_back(packed_colour(colour_of_source(voxel.source)));
  });
  return values;
}

FloatRows rows_of(const ExportedMap& map, const std::vector<float>& values) {
  if (!map.others) return {{kNames.begin(), kNames.begin() + kColumns}, values};
  FloatRows rows{kNames, values, kTypes};
  for (std::size_t source = 0; source <= map.others->size(); ++source) {
    rows.comments.push_back(
        line_of_source(static_cast<SourceNumber>(source), *map.others, map.other_names));
  }
  return rows;
}

}  // namespace

WriteResult write_pcd(const ExportedMap& map, const LayerOrigin& shift,
                      const std::filesystem::path& file) {
  const std::vector<float> values = occupied_values(map, shift);
  return write_rows_pcd(rows_of(map, values), file);
}

WriteResult write_ply(const ExportedMap& map, const LayerOrigin& shift,
                      const std::filesystem::path& file) {
  const std::vector<float> values = occupied_values(map, shift);
  return write_rows_ply(rows_of(map, values), file);
}

}  // namespace warren
