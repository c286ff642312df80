// SPDX-License-Identifier: Apache-2.0
#include "tools/world/body_motion.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"

using namespace warren::world;

namespace {

double yaw_of(const Eigen::Isometry3d& T) { return std::atan2(T(1, 0), T(0, 0)); }

}  // namespace

TEST_CASE("on a straight way a robot keeps its speed and stays on the ground") {
  const TriangleMesh mesh = test::flat(20.0, 0.5);
  const Caster caster(mesh);
  const BodyMotion motion(caster, husky(), {{-8.0, 1.0, 0.4}, {8.0, 1.0, 0.6}},
                          {.speed_m_s = 2.0, .start_s = 3.0});
  CHECK(motion.start_s() == 3.0);
  CHECK(motion.end_s() == doctest::Approx(11.0).epsilon(0.001));
  CHECK(motion.T_world_base(0.0).translation().x() == doctest::Approx(-8.0));
  CHECK(motion.T_world_base(7.0).translation().x() == doctest::Approx(0.0).epsilon(0.01));
  CHECK(motion.T_world_base(99.0).translation().x() == doctest::Approx(8.0));
  for (int step = 0; step < 130; ++step) {
    const Eigen::Isometry3d T = motion.T_world_base(0.1 * step);
    CHECK(T.translation().z() == doctest::Approx(0.5));
    CHECK(T.translation().y() == doctest::Approx(1.0));
    CHECK(T.linear().isIdentity(1e-4));
  }
}

TEST_CASE("on a ramp it pitches as the ramp does") {
  const double slope = 0.3;
  const TriangleMesh mesh = test::ramp(slope);
  const Caster caster(mesh);
  const double top = 8.0 * std::tan(slope);
  const BodyMotion motion(caster, husky(), {{-5.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {8.0, 0.0, top}},
                          {});
  const Eigen::Isometry3d T = motion.T_world_base(5.0 + 4.0 / std::cos(slope));
  CHECK(T.linear()(2, 0) == doctest::Approx(std::sin(slope)).epsilon(0.02));
  CHECK(T.translation().z() ==
        doctest::Approx(T.translation().x() * std::tan(slope)).epsilon(0.01));
}

TEST_CASE("its pose is continuous, through corners and where it turns back") {
  const TriangleMesh mesh = test::step(0.1);
  const Caster caster(mesh);
  const Gait gait{.speed_m_s = 1.0, .turn_rad_s = 0.8};
  const BodyMotion motion(
      caster, husky(),
      {{-4.0, 0.0, 0.0}, {3.0, 0.0, 0.1}, {3.0, 5.0, 0.1}, {3.0, 0.0, 0.1}, {-4.0, -3.0, 0.0}},
      gait);
  constexpr double kStepS = 0.01;
  Eigen::Isometry3d before = motion.T_world_base(0.0);
  for (int step = 1; step * kStepS < motion.end_s() + 1.0; ++step) {
    const Eigen::Isometry3d now = motion.T_world_base(step * kStepS);
    const double way_m = (now.translation() - before.translation()).norm();
    const Eigen::AngleAxisd turn(before.linear().transpose() * now.linear());
    REQUIRE(way_m < 1.05 * gait.speed_m_s * kStepS);
    REQUIRE(std::abs(turn.angle()) < 1.6 * gait.turn_rad_s * kStepS);
    REQUIRE((now.linear() * now.linear().transpose()).isIdentity(1e-9));
    before = now;
  }
}

TEST_CASE("at a dead end it turns on the spot and looks back") {
  const TriangleMesh mesh = test::flat(10.0);
  const Caster caster(mesh);
  const BodyMotion motion(caster, husky(), {{0.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, {});
  CHECK(std::abs(yaw_of(motion.T_world_base(2.0))) < 1e-3);
  CHECK(std::abs(yaw_of(motion.T_world_base(motion.end_s() - 1.0))) ==
        doctest::Approx(std::numbers::pi).epsilon(0.001));
  double furthest_m = 0.0;
  for (int step = 0; 0.1 * step < motion.end_s(); ++step)
    furthest_m = std::max(furthest_m, motion.T_world_base(0.1 * step).translation().x());
  CHECK(furthest_m > 4.5);
}

TEST_CASE("a robot without a way stands where it is and looks where it is told") {
  const TriangleMesh mesh = test::flat(10.0);
  const Caster caster(mesh);
  const BodyMotion motion(caster, spot(), {{1.0, 2.0, 0.0}}, {.yaw_rad = 0.7});
  CHECK(motion.T_world_base(5.0).translation().isApprox(Eigen::Vector3d(1.0, 2.0, 0.0), 1e-4));
  CHECK(yaw_of(motion.T_world_base(5.0)) == doctest::Approx(0.7));
}

TEST_CASE("a tilted sensor looks down") {
  const Eigen::Isometry3d T_base_sensor = sensor_mount(husky(), 0.3);
  CHECK(T_base_sensor.translation().z() == husky().sensor_height_m);
  CHECK((T_base_sensor.linear() * Eigen::Vector3d::UnitX()).z() == doctest::Approx(-std::sin(0.3)));
}
