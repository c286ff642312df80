// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/exchange/decode_error.hpp"

namespace warren {

inline constexpr std::size_t kMaxPcdFields = 1024;
inline constexpr std::size_t kMaxPcdPointBytes = 1U << 16;
inline constexpr std::size_t kMaxPcdHeaderLines = 64;

enum class PcdEncoding : std::uint8_t { kAscii, kBinary, kCompressed };

struct PcdField {
  std::string name;
  std::size_t width = 4;  // bytes of one element
  char type = 'F';        // F float, I signed, U unsigned
  std::size_t count = 1;

  std::size_t bytes() const { return width * count; }
  // Compressed files leave padding out.
  bool is_padding() const { return name == "_"; }
};

// A header that is consistent in itself and within the bounds above; its claims are not yet
// compared with the size of the file.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::array<std::size_t, 3> xyz{};  // indices of the fields x, y, z: floats of count 1
  std::size_t points = 0;            // at most kMaxCloudPoints
  std::size_t point_bytes = 0;
  PcdEncoding encoding = PcdEncoding::kAscii;
  std::size_t data_offset = 0;  // of the first byte after the header
  std::size_t data_line = 0;    // its line number
};

Decoded<PcdHeader> parse_pcd_header(std::string_view bytes);

}  // namespace warren
