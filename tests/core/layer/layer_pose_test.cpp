// SPDX-License-Identifier: Apache-2.0
#include "core/layer/layer_pose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/layer/resolution.hpp"
#include "tests/core/layer/random_codes.hpp"

using namespace warren;

namespace {

Pose pose_of(double x_m, double yaw_rad) {
  return {{x_m, 0.0, 0.0},
          Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))};
}

// So few that some have the same revision and writer.
WrittenPose random_written(test::Random& random) {
  return {1 + test::below(random, 3), test::below(random, 2),
          pose_of(test::below(random, 3), test::below(random, 2))};
}

LayerPose taken(const std::vector<WrittenPose>& poses) {
  LayerPose pose;
  for (const WrittenPose& written : poses) {
    pose.update_origin(written);
    pose.update_correction(written);
  }
  return pose;
}

}  // namespace

TEST_CASE("a layer without a pose lies at the fleet's origin") {
  CHECK(LayerPose{}.T_fleet_layer().isApprox(Eigen::Isometry3d::Identity()));
}

TEST_CASE("the correction moves the layer in the fleet frame, after the origin's pose") {
  LayerPose pose;
  CHECK(pose.update_correction({1, 9, pose_of(10.0, std::numbers::pi / 2)}) == PoseResult::kTaken);
  CHECK(pose.update_origin({1, 7, pose_of(1.0, 0.0)}) == PoseResult::kTaken);
  const Eigen::Vector3d at = pose.T_fleet_layer() * Eigen::Vector3d(1.0, 0.0, 0.0);
  CHECK(at.isApprox(Eigen::Vector3d(10.0, 2.0, 0.0)));
}

TEST_CASE("a newer revision replaces an older one, a higher writer an equal one") {
  LayerPose pose;
  CHECK(pose.update_origin({2, 1, pose_of(1.0, 0.0)}) == PoseResult::kTaken);
  CHECK(pose.update_origin({1, 9, pose_of(2.0, 0.0)}) == PoseResult::kNotNewer);
  CHECK(pose.update_origin({2, 1, pose_of(1.0, 0.0)}) == PoseResult::kNotNewer);
  CHECK(pose.update_origin({2, 2, pose_of(3.0, 0.0)}) == PoseResult::kTaken);
  CHECK(pose.update_origin({3, 0, pose_of(4.0, 0.0)}) == PoseResult::kTaken);
  CHECK(pose.origin() == WrittenPose{3, 0, pose_of(4.0, 0.0)});
  CHECK(pose.correction() == WrittenPose{});
}

TEST_CASE("in whatever order and how often poses arrive, the same is held") {
  CHECK(rc::check("any order, any repetition", [](std::uint64_t seed) {
    test::Random random(seed);
    std::vector<WrittenPose> poses(1 + test::below(random, 8));
    for (WrittenPose& written : poses) written = random_written(random);
    const LayerPose once = taken(poses);
    poses.insert(poses.end(), poses.begin(), poses.end());
    std::shuffle(poses.begin(), poses.end(), random);
    RC_ASSERT(taken(poses) == once);
  }));
}

TEST_CASE("what is no rigid motion, or was never written, is refused and changes nothing") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  LayerPose pose;
  const auto refused = [&](const Pose& wrong) {
    return pose.update_origin({5, 5, wrong}) == PoseResult::kNotRigid &&
           pose.update_correction({5, 5, wrong}) == PoseResult::kNotRigid;
  };
  CHECK(refused(pose_of(kNan, 0.0)));
  CHECK(refused(pose_of(2 * LayerPose::kReach_m, 0.0)));
  Pose scaled;
  scaled.rotation.coeffs() *= 2.0;
  CHECK(refused(scaled));
  CHECK(pose.update_origin({0, 5, pose_of(1.0, 0.0)}) == PoseResult::kNotWritten);
  CHECK(pose.refused() == 6);
  CHECK(pose == LayerPose{});
}

TEST_CASE("resolutions compare exactly, from 1 mm to 10 m") {
  CHECK(Resolution::from_metres(0.15) == Resolution::from_micrometres(150'000));
  CHECK(Resolution::from_metres(0.15)->metres() == 0.15);
  CHECK(Resolution::from_metres(0.1F) == Resolution{});
  CHECK(Resolution::from_metres(0.100001) != Resolution{});
  for (const double wrong : {0.0, -0.1, 0.000999, 10.1, 1e300, std::nan("")}) {
    CHECK_FALSE(Resolution::from_metres(wrong));
  }
  CHECK(Resolution::from_micrometres(Resolution::kMinimum_um));
  CHECK_FALSE(Resolution::from_micrometres(Resolution::kMinimum_um - 1));
  CHECK_FALSE(Resolution::from_micrometres(Resolution::kMaximum_um + 1));
}
