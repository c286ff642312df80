// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/cloud_decoders.hpp"
#include "core/exchange/packed_points.hpp"
#include "core/exchange/ply_header.hpp"

namespace warren {
namespace {

Decoded<Cloud> decode_ascii(std::string_view data, const PlyHeader& header) {
  const std::array<std::size_t, 3> columns = {header.xyz[0].column, header.xyz[1].column,
                                              header.xyz[2].column};
  Cloud cloud;
  LineReader lines(data);
  while (cloud.points.size() < header.vertices) {
    const auto line = lines.next();
    if (!line) {
      return decode_error(0, "cut short: " + std::to_string(cloud.points.size()) + " of " +
                                 std::to_string(header.vertices) + " vertices");
    }
    const std::size_t number = header.data_line + lines.line() - 1;
    std::string_view rest = *line;
    for (std::size_t i = 0; i < header.columns; ++i) {
      if (!take_field(rest).empty()) continue;
      return decode_error(number, "expected " + std::to_string(header.columns) + " columns");
    }
    const PointRow row = parse_point_row(*line, columns);
    if (row.fault != RowFault::kNone) {
      return decode_error(number, "expected a number, found " + in_quotes(row.field));
    }
    cloud.points.push_back(row.point);
  }
  return cloud;
}

Decoded<Cloud> decode_binary(std::string_view data, const PlyHeader& header) {
  const std::size_t bytes_needed = header.vertices * header.vertex_bytes;
  if (data.size() < bytes_needed) {
    return decode_error(0, "cut short: " + std::to_string(header.vertices) + " vertices take " +
                               std::to_string(bytes_needed) + " bytes, " +
                               std::to_string(data.size()) + " are there");
  }
  std::array<PackedAxis, 3> axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes[axis] = {header.xyz[axis].offset, header.vertex_bytes, header.xyz[axis].width};
  }
  return unpack_points(data, axes, header.vertices);
}

}  // namespace

Decoded<Cloud> decode_ply(std::string_view bytes) {
  const auto header = parse_ply_header(bytes);
  if (!header) return tl::make_unexpected(header.error());
  const std::string_view data = bytes.substr(header->data_offset);
  return header->ascii ? decode_ascii(data, *header) : decode_binary(data, *header);
}

}  // namespace warren
