// SPDX-License-Identifier: Apache-2.0
// A pose file, taken for each format in turn: every accepted pose is rigid, and reads back the same
// once printed.
#include <array>
#include <cassert>
#include <charconv>

#include "core/exchange/pose_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace warren::fuzz {
namespace {

constexpr double kRoundingError = 1e-9;

std::string printed_as_tum(const TimedPose& pose) {
  const auto& [translation, q] = pose.T_map_sensor;
  std::string text;
  std::array<char, 32> buffer{};
  for (const double value : {pose.time_s.value_or(0.0), translation.x(), translation.y(),
                             translation.z(), q.x(), q.y(), q.z(), q.w()}) {
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    text.append(buffer.data(), end).append(1, ' ');
  }
  return text;
}

void check_pose(const TimedPose& pose) {
  assert(pose.T_map_sensor.checked().has_value());
  const auto again = parse_poses(printed_as_tum(pose), PoseFormat::kTum);
  assert(again && again->size() == 1);
  const Pose& read = again->front().T_map_sensor;
  assert(again->front().time_s == pose.time_s.value_or(0.0));
  assert(read.translation == pose.T_map_sensor.translation);
  assert(read.rotation.coeffs().isApprox(pose.T_map_sensor.rotation.coeffs(), kRoundingError));
}

void check_format(std::string_view text, PoseFormat format) {
  const auto poses = parse_poses(text, format);
  if (!poses) {
    assert(!poses.error().text.empty() && poses.error().line <= text.size());
    return;
  }
  assert(poses->size() <= text.size());
  for (const TimedPose& pose : *poses) {
    check_pose(pose);
    assert(pose.time_s.has_value() || format != PoseFormat::kTum);
  }
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  for (const auto format : {PoseFormat::kKitti, PoseFormat::kTum, PoseFormat::kMatrix4}) {
    fuzz::check_format(fuzz::text_of(data, size), format);
  }
  return 0;
}
