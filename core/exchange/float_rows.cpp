// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/float_rows.hpp"

#include <bit>
#include <cassert>
#include <cstring>
#include <fstream>

#include <pcl/io/pcd_io.h>

namespace warren {
namespace {

static_assert(std::endian::native == std::endian::little, "the file formats are little endian");

pcl::PCLPointCloud2 as_pcl_cloud(const FloatRows& rows) {
  pcl::PCLPointCloud2 cloud;
  std::uint32_t offset = 0;
  for (const std::string& name : rows.names) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = offset;
    field.datatype = pcl::PCLPointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
    offset += sizeof(float);
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(rows.count());
  cloud.point_step = offset;
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.data.resize(rows.values.size_bytes());
  if (!cloud.data.empty()) {
    std::memcpy(cloud.data.data(), rows.values.data(), cloud.data.size());
  }
  return cloud;
}

}  // namespace

WriteResult write_rows_pcd(const FloatRows& rows, const std::filesystem::path& file) {
  assert(rows.values.size() % rows.names.size() == 0);
  if (pcl::PCDWriter().writeBinary(file.string(), as_pcl_cloud(rows)) == 0) return {};
  return tl::make_unexpected(std::string("PCL could not write the cloud"));
}

WriteResult write_rows_ply(const FloatRows& rows, const std::filesystem::path& file) {
  assert(rows.values.size() % rows.names.size() == 0);
  std::ofstream stream(file, std::ios::binary);
  stream << "ply\nformat binary_little_endian 1.0\nelement vertex " << rows.count() << '\n';
  for (const std::string& name : rows.names) stream << "property float " << name << '\n';
  stream << "end_header\n";
  stream.write(reinterpret_cast<const char*>(rows.values.data()),
               static_cast<std::streamsize>(rows.values.size_bytes()));
  stream.close();
  if (stream) return {};
  return tl::make_unexpected(std::string("the disk refused the data"));
}

}  // namespace warren
