// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/exchange/atomic_file.hpp"

namespace warren {

// A table of float32 values, row after row, with a name per column: what PCD and PLY files hold.
struct FloatRows {
  std::vector<std::string> names;
  std::span<const float> values;  // a multiple of names.size()

  std::size_t count() const { return values.size() / names.size(); }
};

// Binary, little endian. The same rows give the same bytes; NaN stays NaN.
WriteResult write_rows_pcd(const FloatRows& rows, const std::filesystem::path& file);
WriteResult write_rows_ply(const FloatRows& rows, const std::filesystem::path& file);

}  // namespace warren
