// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/exchange/atomic_file.hpp"
#include "core/exchange/image.hpp"

namespace warren {

// What the 32 bits of a value are.
enum class ColumnType : std::uint8_t {
  kFloat,
  kCount,   // an unsigned integer
  kColour,  // packed_colour(); in PLY files three bytes, red, green and blue
};

// A table of 32-bit values, row after row, with a name per column: what PCD and PLY files hold.
struct FloatRows {
  std::vector<std::string> names;
  std::span<const float> values;        // a multiple of names.size()
  std::vector<ColumnType> types{};      // by column; none: all are floats
  std::vector<std::string> comments{};  // lines for the header

  std::size_t count() const { return values.size() / names.size(); }
  ColumnType type(std::size_t column) const {
    return types.empty() ? ColumnType::kFloat : types[column];
  }
};

// As PCL packs it: blue in the lowest byte.
inline float packed_colour(const Colour& colour) {
  return std::bit_cast<float>(std::uint32_t{colour.red} << 16 | std::uint32_t{colour.green} << 8 |
                              std::uint32_t{colour.blue});
}

// Binary, little endian. The same rows give the same bytes; NaN stays NaN.
WriteResult write_rows_pcd(const FloatRows& rows, const std::filesystem::path& file);
WriteResult write_rows_ply(const FloatRows& rows, const std::filesystem::path& file);

}  // namespace warren
