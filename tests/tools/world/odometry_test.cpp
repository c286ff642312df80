// SPDX-License-Identifier: Apache-2.0
#include "tools/world/odometry.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace warren::world;

namespace {

// Starts tilted and turned, then drives 1 m/s along a level circle of 50 m.
Eigen::Isometry3d truth(double time_s) {
  const double angle = time_s / 50.0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(50.0 * std::sin(angle), 50.0 * (1.0 - std::cos(angle)), 3.0);
  T.linear() = (Eigen::AngleAxisd(0.5 + angle, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()))
                   .toRotationMatrix();
  return T;
}

const Odometry::Period kPeriod{2.0, 62.0};

Odometry odometry(const OdometryErrors& errors, std::uint64_t seed = 1,
                  MapFrame frame = MapFrame::kLevelled) {
  return {truth, kPeriod, errors, frame, Random(seed)};
}

Eigen::Isometry3d in_world(const Odometry& belief, double time_s) {
  return belief.T_world_map() * belief.T_map_base(time_s);
}

double yaw_error(const Odometry& belief, double time_s) {
  const Eigen::Matrix3d R = in_world(belief, time_s).linear() * truth(time_s).linear().transpose();
  return std::atan2(R(1, 0), R(0, 0));
}

}  // namespace

TEST_CASE("without errors the robot knows the truth, in a map levelled at its start") {
  const Odometry belief = odometry({});
  CHECK(belief.gravity_map().isApprox(-Eigen::Vector3d::UnitZ()));
  CHECK(belief.T_map_base(2.0).translation().norm() < 1e-9);
  CHECK((belief.T_map_base(2.0).linear() * Eigen::Vector3d::UnitX()).y() ==
        doctest::Approx(0.0));  // it starts looking along the map's x
  for (int step = 0; step < 180; ++step) {
    const double time_s = 2.0 + 0.37 * step;
    CHECK(in_world(belief, time_s).isApprox(truth(time_s), 1e-9));
  }
}

TEST_CASE("a map that is not levelled starts as the robot stands, and tells where down is") {
  const Odometry belief = odometry({}, 1, MapFrame::kAsStarted);
  CHECK(belief.T_map_base(2.0).isApprox(Eigen::Isometry3d::Identity(), 1e-9));
  CHECK((belief.T_world_map().linear() * belief.gravity_map())
            .isApprox(-Eigen::Vector3d::UnitZ(), 1e-9));
}

TEST_CASE("a wrong scale lengthens the way, a drift turns it in proportion to the way") {
  const Odometry longer = odometry({.scale = 0.02});
  const Eigen::Vector3d way = truth(50.0).translation() - truth(2.0).translation();
  CHECK(
      (in_world(longer, 50.0).translation() - truth(2.0).translation()).isApprox(1.02 * way, 1e-3));
  const Odometry turning = odometry({.yaw_drift_rad_m = 0.001});
  CHECK(yaw_error(turning, 32.0) == doctest::Approx(0.030).epsilon(0.01));
  CHECK(yaw_error(turning, 62.0) == doctest::Approx(0.060).epsilon(0.01));
  const Odometry rising = odometry({.z_drift_m_m = 0.01});
  CHECK(in_world(rising, 52.0).translation().z() == doctest::Approx(3.5).epsilon(0.001));
}

TEST_CASE("the random walk of yaw spreads with the root of the way") {
  double squares = 0.0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    const Odometry belief =
        odometry({.yaw_walk_rad_sqrt_m = 0.002}, static_cast<std::uint64_t>(run));
    squares += std::pow(yaw_error(belief, 62.0), 2);
  }
  CHECK(std::sqrt(squares / kRuns) == doctest::Approx(0.002 * std::sqrt(60.0)).epsilon(0.1));
}

TEST_CASE("noise is as large as asked for, and does not accumulate") {
  const Odometry belief = odometry({.noise_m = 0.03, .noise_rad = 0.004});
  double squares = 0.0;
  double yaw_squares = 0.0;
  for (int step = 0; step < 600; ++step) {
    const double time_s = 2.0 + 0.1 * step;
    squares += (in_world(belief, time_s).translation() - truth(time_s).translation()).squaredNorm();
    yaw_squares += std::pow(yaw_error(belief, time_s), 2);
  }
  CHECK(std::sqrt(squares / 1800.0) == doctest::Approx(0.03).epsilon(0.1));
  CHECK(std::sqrt(yaw_squares / 600.0) == doctest::Approx(0.004).epsilon(0.1));
}

TEST_CASE("a jump moves the belief at its time, at once and for good") {
  const Odometry belief =
      odometry({.jumps = {{.time_s = 20.0, .shift_m = {1.0, -2.0, 0.5}, .turn_rad = 0.1},
                          {.time_s = 40.0, .shift_m = {0.0, 3.0, 0.0}}}});
  CHECK(in_world(belief, 19.999).isApprox(truth(19.999), 1e-9));
  const Eigen::Vector3d jumped = in_world(belief, 20.0).translation() - truth(20.0).translation();
  CHECK(jumped.isApprox(Eigen::Vector3d(1.0, -2.0, 0.5), 1e-6));
  CHECK(yaw_error(belief, 30.0) == doctest::Approx(0.1).epsilon(1e-6));
  // It stays consistent with itself: the believed way between two times has the true length.
  CHECK((belief.T_map_base(35.0).translation() - belief.T_map_base(21.0).translation()).norm() ==
        doctest::Approx((truth(35.0).translation() - truth(21.0).translation()).norm()));
  const Eigen::Vector3d second =
      in_world(belief, 40.0).translation() - in_world(belief, 40.0 - 1e-9).translation();
  CHECK((second - Eigen::Vector3d(0.0, 3.0, 0.0)).norm() < 1e-6);
}
