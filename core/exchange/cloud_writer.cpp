// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/cloud_writer.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <vector>

#include <pcl/io/pcd_io.h>

namespace warren {
namespace {

static_assert(std::endian::native == std::endian::little, "the file formats are little endian");

struct CloudRow {
  float x, y, z, p;
};
static_assert(sizeof(CloudRow) == 16);

std::vector<CloudRow> occupied_rows(const MapSnapshot& map, const LayerOrigin& shift) {
  const double resolution_m = map.voxels.lattice().resolution_m();
  const auto centre = [&](std::int64_t key) {
    return static_cast<float>((static_cast<double>(key) + 0.5) * resolution_m);
  };
  std::vector<CloudRow> rows;
  rows.reserve(map.voxels.counts().occupied);
  map.voxels.for_each_known_voxel(
      KeyBox{}, [&](const VoxelKey& key, VoxelState state, float log_odds) {
        if (state != VoxelState::kOccupied) return;
        rows.push_back({centre(key.x + shift.x), centre(key.y + shift.y), centre(key.z + shift.z),
                        1.0F / (1.0F + std::exp(-log_odds))});
      });
  return rows;
}

pcl::PCLPointCloud2 as_pcl_cloud(const std::vector<CloudRow>& rows) {
  pcl::PCLPointCloud2 cloud;
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "p"}) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = offset;
    field.datatype = pcl::PCLPointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
    offset += sizeof(float);
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(rows.size());
  cloud.point_step = sizeof(CloudRow);
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.data.resize(rows.size() * sizeof(CloudRow));
  if (!rows.empty()) std::memcpy(cloud.data.data(), rows.data(), cloud.data.size());
  return cloud;
}

}  // namespace

WriteResult write_pcd(const MapSnapshot& map, const LayerOrigin& shift,
                      const std::filesystem::path& file) {
  const int failed =
      pcl::PCDWriter().writeBinary(file.string(), as_pcl_cloud(occupied_rows(map, shift)));
  if (failed == 0) return {};
  return tl::make_unexpected(std::string("PCL could not write the cloud"));
}

WriteResult write_ply(const MapSnapshot& map, const LayerOrigin& shift,
                      const std::filesystem::path& file) {
  const std::vector<CloudRow> rows = occupied_rows(map, shift);
  std::ofstream stream(file, std::ios::binary);
  stream << "ply\nformat binary_little_endian 1.0\nelement vertex " << rows.size() << '\n';
  for (const char* name : {"x", "y", "z", "p"}) stream << "property float " << name << '\n';
  stream << "end_header\n";
  stream.write(reinterpret_cast<const char*>(rows.data()),
               static_cast<std::streamsize>(rows.size() * sizeof(CloudRow)));
  stream.close();
  if (stream) return {};
  return tl::make_unexpected(std::string("the disk refused the data"));
}

}  // namespace warren
