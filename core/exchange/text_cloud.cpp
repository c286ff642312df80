// SPDX-License-Identifier: Apache-2.0
// Clouds without a header of their own: columns of text, and KITTI's records.
#include <optional>

#include "core/exchange/cloud_decoders.hpp"
#include "core/exchange/packed_points.hpp"

namespace warren {
namespace {

using Columns = std::array<std::size_t, 3>;

constexpr std::size_t kKittiRecordBytes = 16;
constexpr std::size_t kMaxNamedColumns = 256;

bool is_blank_or_comment(std::string_view line) {
  const std::string_view first = take_field(line);
  return first.empty() || first.front() == '#' || first.substr(0, 2) == "//";
}

bool has_number(std::string_view line) {
  for (std::size_t i = 0; i < kMaxNamedColumns; ++i) {
    const std::string_view field = take_field(line);
    if (field.empty()) return false;
    if (to_number(field)) return true;
  }
  return false;
}

// Columns that a line of names calls x, y and z; the first three when it does not.
Columns columns_of(std::string_view names) {
  std::array<std::optional<std::size_t>, 3> found;
  for (std::size_t column = 0; column < kMaxNamedColumns; ++column) {
    const std::string_view name = take_field(names);
    if (name.empty()) break;
    for (std::size_t axis = 0; axis < found.size(); ++axis) {
      const bool same = name.size() == 1 && (name[0] | 0x20) == "xyz"[axis];
      if (same && !found[axis]) found[axis] = column;
    }
  }
  if (!found[0] || !found[1] || !found[2]) return {0, 1, 2};
  return {*found[0], *found[1], *found[2]};
}

std::string row_error(const PointRow& row) {
  if (row.fault == RowFault::kTooFewFields) return "expected x y z, found fewer columns";
  return "expected a number, found " + in_quotes(row.field);
}

}  // namespace

Decoded<Cloud> decode_text_cloud(std::string_view bytes) {
  Cloud cloud;
  Columns columns{0, 1, 2};
  LineReader lines(bytes);
  bool first = true;
  while (const auto line = lines.next()) {
    if (is_blank_or_comment(*line)) continue;
    if (std::exchange(first, false) && !has_number(*line)) {
      columns = columns_of(*line);
      continue;
    }
    const PointRow row = parse_point_row(*line, columns);
    if (row.fault != RowFault::kNone) return decode_error(lines.line(), row_error(row));
    if (cloud.points.size() == kMaxCloudPoints) {
      return decode_error(lines.line(), "more than " + std::to_string(kMaxCloudPoints) + " points");
    }
    cloud.points.push_back(row.point);
  }
  return cloud;
}

Decoded<Cloud> decode_kitti_bin(std::string_view bytes) {
  if (bytes.size() % kKittiRecordBytes != 0) {
    return decode_error(0, std::to_string(bytes.size()) +
                               " bytes are no whole number of 16-byte records x y z intensity");
  }
  const std::size_t count = bytes.size() / kKittiRecordBytes;
  if (count > kMaxCloudPoints) {
    return decode_error(0, "more than " + std::to_string(kMaxCloudPoints) + " points");
  }
  return unpack_points(
      bytes, {{{0, kKittiRecordBytes, 4}, {4, kKittiRecordBytes, 4}, {8, kKittiRecordBytes, 4}}},
      count);
}

}  // namespace warren
