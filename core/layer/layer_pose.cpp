// SPDX-License-Identifier: Apache-2.0
#include "core/layer/layer_pose.hpp"

#include <array>
#include <tuple>

namespace warren {
namespace {

std::array<double, 7> numbers_of(const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

auto rank_of(const WrittenPose& written) {
  return std::tuple(written.revision, written.writer, numbers_of(written.pose));
}

bool is_within_reach(const Pose& pose) {
  return pose.checked() && pose.translation.cwiseAbs().maxCoeff() <= LayerPose::kReach_m;
}

// Zero has two signs that compare equal; one of them is kept.
Pose without_negative_zeros(Pose pose) {
  pose.translation.array() += 0.0;
  pose.rotation.coeffs().array() += 0.0;
  return pose;
}

}  // namespace

bool operator==(const WrittenPose& a, const WrittenPose& b) { return rank_of(a) == rank_of(b); }

Eigen::Isometry3d LayerPose::T_fleet_layer() const {
  return *correction_.pose.checked() * *origin_.pose.checked();
}

PoseResult LayerPose::update(WrittenPose& held, const WrittenPose& written) {
  if (written.revision == 0) return PoseResult::kNotWritten;
  if (!is_within_reach(written.pose)) {
    ++refused_;
    return PoseResult::kNotRigid;
  }
  if (rank_of(written) <= rank_of(held)) return PoseResult::kNotNewer;
  held = {written.revision, written.writer, without_negative_zeros(written.pose)};
  return PoseResult::kTaken;
}

}  // namespace warren
