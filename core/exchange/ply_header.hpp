// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/exchange/decode_error.hpp"

namespace warren {

inline constexpr std::size_t kMaxPlyHeaderLines = 4096;
inline constexpr std::size_t kMaxPlyPointBytes = 1U << 16;

// What it takes to find the vertices. Claims are not yet compared with the size of the file.
struct PlyHeader {
  bool ascii = true;  // else binary, little endian
  std::size_t vertices = 0;
  std::size_t columns = 0;
  std::size_t vertex_bytes = 0;
  struct Axis {
    std::size_t column = 0;
    std::size_t offset = 0;
    std::size_t width = 4;
  };
  std::array<Axis, 3> xyz{};
  std::size_t data_offset = 0;
  std::size_t data_line = 0;
};

// Vertices must be the first element, their properties scalars, x y z float or double.
Decoded<PlyHeader> parse_ply_header(std::string_view bytes);

}  // namespace warren
