// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/exchange/cloud_reader.hpp"
#include "core/exchange/text_fields.hpp"

namespace warren {

// Where one coordinate of the points lies in a buffer: float32 or float64, little endian.
struct PackedAxis {
  std::size_t offset = 0;
  std::size_t stride = 0;
  std::size_t width = 4;  // bytes: 4 or 8
};

// Precondition: all `count` values lie within the bytes.
Cloud unpack_points(std::string_view bytes, const std::array<PackedAxis, 3>& axes,
                    std::size_t count);

// Nearest float; beyond its range infinity.
float to_float(double value);

enum class RowFault { kNone, kTooFewFields, kNotANumber };

// x, y, z of a line of fields; `field` is the one at fault.
struct PointRow {
  Point3f point;
  RowFault fault = RowFault::kNone;
  std::string_view field;
};
PointRow parse_point_row(std::string_view line, const std::array<std::size_t, 3>& columns);

}  // namespace warren
