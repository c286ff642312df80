// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/pose_file.hpp"

#include <array>
#include <cmath>
#include <new>

#include <Eigen/SVD>

#include "core/exchange/file_bytes.hpp"
#include "core/exchange/text_fields.hpp"

namespace warren {
namespace {

constexpr double kMaxQuaternionError = 0.01;  // of the norm; as Pose::checked() has it
constexpr double kMaxBottomRowError = 1e-6;

struct FormatTraits {
  std::string_view name;
  std::size_t numbers_per_line;
  std::size_t lines_per_pose;
};

FormatTraits traits_of(PoseFormat format) {
  switch (format) {
    case PoseFormat::kTum:
      return {"time_s x y z qx qy qz qw", 8, 1};
    case PoseFormat::kMatrix4:
      return {"one row of a 4x4 matrix", 4, 4};
    case PoseFormat::kKitti:
      break;
  }
  return {"a 3x4 matrix row by row", 12, 1};
}

using Numbers = std::array<double, 16>;  // of one pose

// Reads exactly `count` finite numbers; the fault is empty when it worked.
std::string read_row(std::string_view line, std::span<double> row, const FormatTraits& traits) {
  const std::string wanted =
      std::to_string(row.size()) + " numbers (" + std::string(traits.name) + ")";
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string_view field = take_field(line);
    if (field.empty()) return "expected " + wanted + ", found " + std::to_string(i);
    const auto number = to_number(field);
    if (!number || !std::isfinite(*number)) {
      return "expected a finite number, found " + in_quotes(field);
    }
    row[i] = *number;
  }
  if (take_field(line).empty()) return {};
  return "expected " + wanted + ", found more; is it another format?";
}

// The rotation nearest to a matrix, in Frobenius norm.
tl::expected<Eigen::Quaterniond, std::string> nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  const bool mirrors = rotation.determinant() < 0.0;
  if (mirrors || !((rotation - matrix).norm() <= kMaxRotationError)) {
    return tl::make_unexpected(std::string("its 3x3 part is no rotation"));
  }
  return Eigen::Quaterniond(rotation).normalized();
}

// Twelve numbers, row by row.
tl::expected<Pose, std::string> pose_of_matrix(const Numbers& n) {
  Eigen::Matrix3d matrix;
  matrix << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  auto rotation = nearest_rotation(matrix);
  if (!rotation) return tl::make_unexpected(rotation.error());
  return Pose{{n[3], n[7], n[11]}, *rotation};
}

tl::expected<TimedPose, std::string> pose_of_kitti(const Numbers& n) {
  auto pose = pose_of_matrix(n);
  if (!pose) return tl::make_unexpected(pose.error());
  return TimedPose{*pose, std::nullopt};
}

tl::expected<TimedPose, std::string> pose_of_matrix4(const Numbers& n) {
  if (!(std::abs(n[12]) + std::abs(n[13]) + std::abs(n[14]) <= kMaxBottomRowError)) {
    return tl::make_unexpected(std::string("the matrix's last row does not begin with 0 0 0"));
  }
  auto pose = pose_of_matrix(n);
  if (!pose) return tl::make_unexpected(pose.error());
  const bool has_time = std::abs(n[15] - 1.0) > kMaxBottomRowError;
  return TimedPose{*pose, has_time ? std::optional(n[15]) : std::nullopt};
}

tl::expected<TimedPose, std::string> pose_of_tum(const Numbers& n) {
  const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
  if (!(std::abs(rotation.norm() - 1.0) <= kMaxQuaternionError)) {
    return tl::make_unexpected(std::string("the quaternion's norm is not 1"));
  }
  return TimedPose{{{n[1], n[2], n[3]}, rotation.normalized()}, n[0]};
}

tl::expected<TimedPose, std::string> pose_of(const Numbers& numbers, PoseFormat format) {
  switch (format) {
    case PoseFormat::kTum:
      return pose_of_tum(numbers);
    case PoseFormat::kMatrix4:
      return pose_of_matrix4(numbers);
    case PoseFormat::kKitti:
      break;
  }
  return pose_of_kitti(numbers);
}

}  // namespace

std::optional<PoseFormat> pose_format_of(std::string_view name) {
  if (name == "kitti") return PoseFormat::kKitti;
  if (name == "tum") return PoseFormat::kTum;
  if (name == "matrix4") return PoseFormat::kMatrix4;
  return std::nullopt;
}

Decoded<std::vector<TimedPose>> parse_poses(std::string_view text, PoseFormat format) {
  const FormatTraits traits = traits_of(format);
  std::vector<TimedPose> poses;
  Numbers numbers{};
  std::size_t rows = 0;
  LineReader lines(text);
  while (const auto line = lines.next()) {
    std::string_view rest = *line;
    const std::string_view first = take_field(rest);
    if (first.empty() || first.front() == '#') continue;
    const std::span<double> row(&numbers[rows * traits.numbers_per_line], traits.numbers_per_line);
    const std::string fault = read_row(*line, row, traits);
    if (!fault.empty()) return decode_error(lines.line(), fault);
    if (++rows < traits.lines_per_pose) continue;
    rows = 0;
    auto pose = pose_of(numbers, format);
    if (!pose) return decode_error(lines.line(), pose.error());
    if (poses.size() == kMaxPoses) {
      return decode_error(lines.line(), "more than " + std::to_string(kMaxPoses) + " poses");
    }
    poses.push_back(*pose);
  }
  if (rows == 0) return poses;
  return decode_error(lines.line(), "the last matrix is cut short");
}

tl::expected<std::vector<TimedPose>, std::string> read_poses(const std::filesystem::path& file,
                                                             PoseFormat format) {
  const auto text = read_file_bytes(file, kMaxPoseFileBytes);
  if (!text) return tl::make_unexpected(text.error());
  try {
    auto poses = parse_poses(*text, format);
    if (!poses) return tl::make_unexpected(poses.error().located(file.string()));
    return *std::move(poses);
  } catch (const std::bad_alloc&) {
    return tl::make_unexpected(file.string() + ": not enough memory for its poses");
  }
}

}  // namespace warren
