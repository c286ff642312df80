// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/natural_order.hpp"
#include "core/exchange/pose_file.hpp"

namespace warren {
namespace {

std::string counts_differ(std::size_t files, std::size_t poses) {
  return std::to_string(files) + " clouds but " + std::to_string(poses) +
         " poses, so a cloud's pose is the one with the number in its name; ";
}

}  // namespace

tl::expected<std::vector<TimedPose>, std::string> pair_poses(
    std::span<const std::filesystem::path> files, std::span<const TimedPose> poses) {
  if (files.size() == poses.size()) return std::vector<TimedPose>(poses.begin(), poses.end());
  std::vector<TimedPose> paired;
  paired.reserve(files.size());
  for (const std::filesystem::path& file : files) {
    const auto number = last_number_in(file.stem().string());
    if (!number) {
      return tl::make_unexpected(counts_differ(files.size(), poses.size()) +
                                 file.filename().string() + " has none");
    }
    if (*number >= poses.size()) {
      const std::string range =
          poses.empty() ? "there are none" : "they end at " + std::to_string(poses.size() - 1);
      return tl::make_unexpected(counts_differ(files.size(), poses.size()) + "but for " +
                                 file.filename().string() + " " + range + " (counted from 0)");
    }
    paired.push_back(poses[*number]);
  }
  return paired;
}

}  // namespace warren
