// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/block_runs.hpp"

#include <algorithm>

#include "core/voxel/morton.hpp"

namespace warren {
namespace {

constexpr std::uint8_t kRun = 128;
constexpr std::uint8_t kToTheEnd = 255;
constexpr std::size_t kRunLeast = 2;
constexpr std::size_t kRunMost = kRunLeast + kToTheEnd - 1;

std::array<std::uint8_t, kVoxelsPerBlock> by_rows(const BlockVoxels& voxels) {
  std::array<std::uint8_t, kVoxelsPerBlock> rows{};
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelKey key = place_of_morton9(place);
    rows[static_cast<std::size_t>(key.x + 8 * key.y + 64 * key.z)] = voxels[place].bits();
  }
  return rows;
}

}  // namespace

void append_runs(const BlockVoxels& voxels, std::string& bytes) {
  const auto rows = by_rows(voxels);
  for (std::size_t at = 0; at < rows.size();) {
    const auto* const end = std::find_if(rows.begin() + at, rows.end(),
                                         [&](std::uint8_t code) { return code != rows[at]; });
    const auto length = static_cast<std::size_t>(end - (rows.begin() + at));
    const bool is_last = end == rows.end();
    const std::size_t told = is_last ? length : std::min(length, kRunMost);
    if (told < kRunLeast) {
      bytes.push_back(static_cast<char>(rows[at]));
    } else {
      bytes.push_back(static_cast<char>(rows[at] | kRun));
      bytes.push_back(static_cast<char>(is_last ? kToTheEnd : told - kRunLeast));
    }
    at += told;
  }
}

}  // namespace warren
