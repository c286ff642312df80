// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/packed_points.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

namespace warren {
namespace {

static_assert(std::endian::native == std::endian::little, "the file formats are little endian");

template <typename T>
T load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

float load_axis(std::string_view bytes, const PackedAxis& axis, std::size_t index) {
  const char* at = bytes.data() + axis.offset + index * axis.stride;
  return axis.width == sizeof(double) ? to_float(load<double>(at)) : load<float>(at);
}

}  // namespace

float to_float(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (std::abs(value) > kLargest) {
    return std::copysign(std::numeric_limits<float>::infinity(), value < 0.0 ? -1.0F : 1.0F);
  }
  return static_cast<float>(value);
}

Cloud unpack_points(std::string_view bytes, const std::array<PackedAxis, 3>& axes,
                    std::size_t count) {
  for (const PackedAxis& axis : axes) {
    assert(count == 0 || axis.offset + (count - 1) * axis.stride + axis.width <= bytes.size());
  }
  Cloud cloud;
  cloud.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.push_back(
        {load_axis(bytes, axes[0], i), load_axis(bytes, axes[1], i), load_axis(bytes, axes[2], i)});
  }
  return cloud;
}

PointRow parse_point_row(std::string_view line, const std::array<std::size_t, 3>& columns) {
  const std::size_t last = *std::max_element(columns.begin(), columns.end());
  PointRow row;
  std::array<float*, 3> axes = {&row.point.x, &row.point.y, &row.point.z};
  for (std::size_t column = 0; column <= last; ++column) {
    row.field = take_field(line);
    if (row.field.empty()) {
      row.fault = RowFault::kTooFewFields;
      return row;
    }
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      if (columns[axis] != column) continue;
      const auto number = to_number(row.field);
      if (!number) {
        row.fault = RowFault::kNotANumber;
        return row;
      }
      *axes[axis] = to_float(*number);
    }
  }
  return row;
}

}  // namespace warren
