// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "core/exchange/decode_error.hpp"
#include "core/voxel/scan.hpp"

namespace warren {

inline constexpr std::size_t kMaxPoses = 10'000'000;
inline constexpr std::uint64_t kMaxPoseFileBytes = std::uint64_t{1} << 30;
// Printed matrices are rotations up to rounding; farther off (Frobenius norm) they are an error.
inline constexpr double kMaxRotationError = 0.02;

enum class PoseFormat : std::uint8_t {
  kKitti,    // per line 12 numbers: the upper 3x4 of T_map_sensor, row by row
  kTum,      // per line: time_s x y z qx qy qz qw
  kMatrix4,  // per pose 4 lines of 4 numbers; [3][3] is 1, or else the time in seconds
};
// "kitti", "tum" or "matrix4".
std::optional<PoseFormat> pose_format_of(std::string_view name);

struct TimedPose {
  Pose T_map_sensor;  // metres; the rotation is normalised
  std::optional<double> time_s;
};

// Numbers are separated by spaces, tabs or commas; blank lines and # comments are skipped.
Decoded<std::vector<TimedPose>> parse_poses(std::string_view text, PoseFormat format);

// The same from a file; the error names file and line.
tl::expected<std::vector<TimedPose>, std::string> read_poses(const std::filesystem::path& file,
                                                             PoseFormat format);

// The pose of each cloud file: by line when there are as many poses as files; otherwise by the last
// number in the file's name, counted from 0 (full12.pcd: the 13th pose). An error says why neither
// works.
tl::expected<std::vector<TimedPose>, std::string> pair_poses(
    std::span<const std::filesystem::path> files, std::span<const TimedPose> poses);

}  // namespace warren
