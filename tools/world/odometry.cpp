// SPDX-License-Identifier: Apache-2.0
#include "tools/world/odometry.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace warren::world {
namespace {

constexpr double kStepS = 0.1;

Eigen::Matrix3d about_z(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

Eigen::Isometry3d frame_of(const Eigen::Isometry3d& T_world_base, MapFrame frame) {
  if (frame == MapFrame::kAsStarted) return T_world_base;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = T_world_base.translation();
  T.linear() = about_z(std::atan2(T_world_base(1, 0), T_world_base(0, 0)));
  return T;
}

// What accumulates, with what does not on top of it.
struct DeadReckoning {
  Eigen::Vector3d position;  // believed, world frame
  double yaw_rad = 0.0;      // believed minus true

  void advance(const Eigen::Vector3d& way, const OdometryErrors& errors, Random& random) {
    const double way_m = way.norm();
    position += about_z(yaw_rad) * way * (1.0 + errors.scale);
    position.z() += errors.z_drift_m_m * way_m;
    yaw_rad += errors.yaw_drift_rad_m * way_m +
               errors.yaw_walk_rad_sqrt_m * std::sqrt(way_m) * random.normal();
  }
};

Eigen::Vector3d noise(double sigma_m, Random& random) {
  const double x = random.normal();
  const double y = random.normal();
  return sigma_m * Eigen::Vector3d(x, y, random.normal());
}

}  // namespace

Odometry::Odometry(const Truth& truth, const Period& period, const OdometryErrors& errors,
                   MapFrame frame, Random random)
    : truth_(truth),
      start_s_(period.start_s),
      T_world_map_(frame_of(truth(period.start_s), frame)) {
  assert(period.end_s >= period.start_s);
  const auto steps = static_cast<int>(std::ceil((period.end_s - period.start_s) / kStepS)) + 1;
  Eigen::Vector3d before = truth(period.start_s).translation();
  DeadReckoning reckoning{before};
  for (int step = 0; step < steps; ++step) {
    const Eigen::Vector3d now = truth(period.start_s + step * kStepS).translation();
    reckoning.advance(now - before, errors, random);
    deviations_.push_back({reckoning.position - now + noise(errors.noise_m, random),
                           reckoning.yaw_rad + errors.noise_rad * random.normal()});
    before = now;
  }
  for (const OdometryErrors::Jump& jump : errors.jumps) add_jump(jump);
}

Odometry::Deviation Odometry::deviation_at(double time_s) const {
  const std::size_t last = deviations_.size() - 1;
  const double place = std::clamp((time_s - start_s_) / kStepS, 0.0, static_cast<double>(last));
  const auto lower = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(lower);
  const Deviation& a = deviations_[lower];
  const Deviation& b = deviations_[std::min(last, lower + 1)];
  return {a.position + share * (b.position - a.position),
          a.yaw_rad + share * (b.yaw_rad - a.yaw_rad)};
}

Eigen::Isometry3d Odometry::without_jumps(double time_s) const {
  const Deviation deviation = deviation_at(time_s);
  Eigen::Isometry3d T_world_base = truth_(time_s);
  T_world_base.translation() += deviation.position;
  T_world_base.linear() = about_z(deviation.yaw_rad) * T_world_base.linear();
  return T_world_base;
}

void Odometry::add_jump(const OdometryErrors::Jump& jump) {
  assert(moved_.empty() || jump.time_s >= moved_.back().from_s);
  const Eigen::Isometry3d before = jumped(jump.time_s);
  const Eigen::Vector3d robot = before * without_jumps(jump.time_s).translation();
  const Eigen::Isometry3d turn(Eigen::Translation3d(robot + jump.shift_m) *
                               Eigen::Isometry3d(about_z(jump.turn_rad)) *
                               Eigen::Translation3d(-robot));
  moved_.push_back({jump.time_s, turn * before});
}

Eigen::Isometry3d Odometry::jumped(double time_s) const {
  const auto next = std::ranges::upper_bound(moved_, time_s, {}, &Moved::from_s);
  return next == moved_.begin() ? Eigen::Isometry3d::Identity() : (next - 1)->by;
}

Eigen::Isometry3d Odometry::T_map_base(double time_s) const {
  return T_world_map_.inverse() * jumped(time_s) * without_jumps(time_s);
}

}  // namespace warren::world
