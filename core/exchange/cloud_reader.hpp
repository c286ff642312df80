// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/voxel/point.hpp"

namespace warren {

inline constexpr std::uint64_t kMaxCloudPoints = 50'000'000;
inline constexpr std::uint64_t kMaxCloudFileBytes = std::uint64_t{4} << 30;

// Points in the order and frame of the file, metres; NaN stays where a beam had no return.
struct Cloud {
  std::vector<Point3f> points;
};

// Reads one cloud, by ending: .pcd, .ply, .bin (KITTI), .txt .xyz .dat .csv (columns x y z). Never
// throws; the error names file, line where there is one, and what was expected. A file that is cut
// short is an error, not a smaller cloud.
tl::expected<Cloud, std::string> read_cloud(const std::filesystem::path& file);

// The file itself, or the files of a directory that have a known ending, in natural order
// (full2.pcd before full10.pcd). Text files count only where there is no .pcd, .ply or .bin: beside
// these they hold poses or notes. Not recursive; an error when there are none.
tl::expected<std::vector<std::filesystem::path>, std::string> list_clouds(
    const std::filesystem::path& file_or_directory);

}  // namespace warren
