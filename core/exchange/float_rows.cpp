// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/float_rows.hpp"

#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <fstream>
#include <utility>

#include <pcl/io/pcd_io.h>

namespace warren {
namespace {

static_assert(std::endian::native == std::endian::little, "the file formats are little endian");

pcl::PCLPointCloud2 as_pcl_cloud(const FloatRows& rows) {
  pcl::PCLPointCloud2 cloud;
  std::uint32_t offset = 0;
  for (std::size_t column = 0; column < rows.names.size(); ++column) {
    pcl::PCLPointField field;
    field.name = rows.names[column];
    field.offset = offset;
    field.datatype = rows.type(column) == ColumnType::kCount ? pcl::PCLPointField::UINT32
                                                             : pcl::PCLPointField::FLOAT32;
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

WriteResult closed(std::ofstream& stream) {
  stream.close();
  if (stream) return {};
  return tl::make_unexpected(std::string("the disk refused the data"));
}

void write_values(const FloatRows& rows, std::ofstream& stream) {
  stream.write(reinterpret_cast<const char*>(rows.values.data()),
               static_cast<std::streamsize>(rows.values.size_bytes()));
}

// PCL's writer knows no comments; they stand between its first line and the rest.
WriteResult write_commented_pcd(const FloatRows& rows, const std::filesystem::path& file) {
  const std::string header = pcl::PCDWriter().generateHeaderBinary(
      as_pcl_cloud(rows), Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity());
  const std::size_t first_line = header.find('\n') + 1;
  std::ofstream stream(file, std::ios::binary);
  stream << header.substr(0, first_line);
  for (const std::string& comment : rows.comments) stream << "# " << comment << '\n';
  stream << header.substr(first_line) << "DATA binary\n";
  write_values(rows, stream);
  return closed(stream);
}

void write_ply_property(const std::string& name, ColumnType type, std::ofstream& stream) {
  if (type == ColumnType::kColour) {
    stream << "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  } else {
    stream << "property " << (type == ColumnType::kCount ? "uint " : "float ") << name << '\n';
  }
}

// A colour takes three bytes, red first; all else its four.
void write_ply_values(const FloatRows& rows, std::ofstream& stream) {
  for (std::size_t i = 0; i < rows.values.size(); ++i) {
    const float value = rows.values[i];
    std::array<char, sizeof value> bytes = std::bit_cast<std::array<char, sizeof value>>(value);
    std::streamsize size = bytes.size();
    if (rows.type(i % rows.names.size()) == ColumnType::kColour) {
      std::swap(bytes[0], bytes[2]);
      size = 3;
    }
    stream.write(bytes.data(), size);
  }
}

}  // namespace

WriteResult write_rows_pcd(const FloatRows& rows, const std::filesystem::path& file) {
  assert(rows.values.size() % rows.names.size() == 0);
  if (!rows.comments.empty()) return write_commented_pcd(rows, file);
  if (pcl::PCDWriter().writeBinary(file.string(), as_pcl_cloud(rows)) == 0) return {};
  return tl::make_unexpected(std::string("PCL could not write the cloud"));
}

WriteResult write_rows_ply(const FloatRows& rows, const std::filesystem::path& file) {
  assert(rows.values.size() % rows.names.size() == 0);
  std::ofstream stream(file, std::ios::binary);
  stream << "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : rows.comments) stream << "comment " << comment << '\n';
  stream << "element vertex " << rows.count() << '\n';
  for (std::size_t column = 0; column < rows.names.size(); ++column) {
    write_ply_property(rows.names[column], rows.type(column), stream);
  }
  stream << "end_header\n";
  if (rows.types.empty()) {
    write_values(rows, stream);
  } else {
    write_ply_values(rows, stream);
  }
  return closed(stream);
}

}  // namespace warren
