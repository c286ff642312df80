// SPDX-License-Identifier: Apache-2.0
// PCL's own reader is not used on files from outside: it crashes on an empty one and allocates
// whatever a header asks for. Only its LZF decompressor is, which checks its bounds.
#include <cstring>

#include <pcl/io/lzf.h>

#include "core/exchange/cloud_decoders.hpp"
#include "core/exchange/packed_points.hpp"
#include "core/exchange/pcd_header.hpp"

namespace warren {
namespace {

// LZF's longest back reference makes 264 bytes out of 3.
constexpr std::size_t kMaxLzfExpansion = 88;

std::string short_file(std::size_t points, std::size_t bytes_needed, std::size_t bytes) {
  return "cut short: " + std::to_string(points) + " points take " + std::to_string(bytes_needed) +
         " bytes, " + std::to_string(bytes) + " are there";
}

Decoded<Cloud> decode_ascii(std::string_view data, const PcdHeader& header) {
  std::array<std::size_t, 3> columns{};
  std::size_t columns_total = 0;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (header.xyz[axis] == i) columns[axis] = columns_total;
    }
    columns_total += header.fields[i].count;
  }
  Cloud cloud;
  LineReader lines(data);
  while (const auto line = lines.next()) {
    std::string_view rest = *line;
    if (take_field(rest).empty()) continue;
    const std::size_t number = header.data_line + lines.line() - 1;
    if (cloud.points.size() == header.points) {
      return decode_error(number, "more points than the header's " + std::to_string(header.points));
    }
    for (std::size_t i = 1; i < columns_total; ++i) {
      if (!take_field(rest).empty()) continue;
      return decode_error(number, "expected " + std::to_string(columns_total) + " columns");
    }
    const PointRow row = parse_point_row(*line, columns);
    if (row.fault != RowFault::kNone) {
      return decode_error(number, "expected a number, found " + in_quotes(row.field));
    }
    cloud.points.push_back(row.point);
  }
  if (cloud.points.size() == header.points) return cloud;
  return decode_error(0, "cut short: " + std::to_string(cloud.points.size()) + " of " +
                             std::to_string(header.points) + " points");
}

Decoded<Cloud> decode_binary(std::string_view data, const PcdHeader& header) {
  const std::size_t bytes_needed = header.points * header.point_bytes;
  if (data.size() < bytes_needed) {
    return decode_error(0, short_file(header.points, bytes_needed, data.size()));
  }
  std::array<PackedAxis, 3> axes;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (header.xyz[axis] == i) axes[axis] = {offset, header.point_bytes, header.fields[i].width};
    }
    offset += header.fields[i].bytes();
  }
  return unpack_points(data, axes, header.points);
}

// One array per field after the other, without padding.
Decoded<Cloud> unpack_arrays(std::string_view data, const PcdHeader& header) {
  std::array<PackedAxis, 3> axes;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    const PcdField& field = header.fields[i];
    if (field.is_padding()) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (header.xyz[axis] == i) axes[axis] = {offset, field.width, field.width};
    }
    offset += field.bytes() * header.points;
  }
  if (data.size() == offset) return unpack_points(data, axes, header.points);
  return decode_error(0, std::to_string(header.points) + " points take " + std::to_string(offset) +
                             " bytes, the compressed data holds " + std::to_string(data.size()));
}

Decoded<Cloud> decode_compressed(std::string_view data, const PcdHeader& header) {
  std::array<std::uint32_t, 2> sizes{};  // compressed, uncompressed
  if (data.size() < sizeof sizes) return decode_error(0, "cut short: no compressed data");
  std::memcpy(sizes.data(), data.data(), sizeof sizes);
  data.remove_prefix(sizeof sizes);
  if (data.size() < sizes[0]) {
    return decode_error(0, short_file(header.points, sizes[0], data.size()));
  }
  if (sizes[1] / kMaxLzfExpansion > sizes[0]) {
    return decode_error(0, "the compressed data cannot be as long as it claims");
  }
  std::string raw(sizes[1], '\0');
  if (sizes[1] != 0 &&
      pcl::lzfDecompress(data.data(), sizes[0], raw.data(), sizes[1]) != sizes[1]) {
    return decode_error(0, "the compressed data is damaged");
  }
  return unpack_arrays(raw, header);
}

}  // namespace

Decoded<Cloud> decode_pcd(std::string_view bytes) {
  const auto header = parse_pcd_header(bytes);
  if (!header) return tl::make_unexpected(header.error());
  const std::string_view data = bytes.substr(header->data_offset);
  switch (header->encoding) {
    case PcdEncoding::kAscii:
      return decode_ascii(data, *header);
    case PcdEncoding::kBinary:
      return decode_binary(data, *header);
    case PcdEncoding::kCompressed:
      return decode_compressed(data, *header);
  }
  return decode_error(0, "unknown encoding");
}

}  // namespace warren
