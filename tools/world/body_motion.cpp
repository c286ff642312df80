// SPDX-License-Identifier: Apache-2.0
#include "tools/world/body_motion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "tools/world/placement.hpp"
#include "tools/world/smoothing.hpp"

namespace warren::world {
namespace {

constexpr double kSpacingM = 0.1;

// One value per place along the way.
struct Track {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  std::vector<double> yaw;    // without jumps of a turn
  std::vector<double> climb;  // pitch and roll as the ground makes them
  std::vector<double> bank;

  std::size_t size() const { return x.size(); }
  void add(const Eigen::Vector3d& place) {
    x.push_back(place.x());
    y.push_back(place.y());
    z.push_back(place.z());
  }
};

Track spread_evenly(const Route& route) {
  Track track;
  track.add(route.front());
  for (std::size_t i = 1; i < route.size(); ++i) {
    const Eigen::Vector3d way = route[i] - route[i - 1];
    const int parts = static_cast<int>(std::ceil(way.norm() / kSpacingM));
    for (int part = 1; part <= parts; ++part) track.add(route[i - 1] + way * part / parts);
  }
  return track;
}

// Backwards is not forwards: at a dead end, the direction jumps by half a turn between two samples,
// and the time that this takes is given to it below.
std::vector<double> directions(const Track& track, double start_yaw_rad) {
  std::vector<double> yaw(track.size(), start_yaw_rad);
  for (std::size_t i = 0; i + 1 < track.size(); ++i) {
    const double dx = track.x[i + 1] - track.x[i];
    const double dy = track.y[i + 1] - track.y[i];
    const double before = i > 0 ? yaw[i - 1] : start_yaw_rad;
    const bool stands = dx == 0.0 && dy == 0.0;
    const double turn =
        stands ? 0.0 : std::remainder(std::atan2(dy, dx) - before, 2.0 * std::numbers::pi);
    yaw[i] = before + turn;
  }
  if (yaw.size() > 1) yaw.back() = yaw[yaw.size() - 2];
  return yaw;
}

// The way's own height is a guess; where the vehicle finds no place it is all there is.
void rest_on_ground(const Caster& caster, const Vehicle& vehicle, Track& track) {
  double lift_m = 0.0;  // of the ground above the route
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double route_z = track.z[i];
    Placement placement;
    for (const double near_z : {route_z, route_z + lift_m}) {
      placement = place(caster, vehicle, {track.x[i], track.y[i], near_z, track.yaw[i]});
      if (placement.T_world_base) break;
    }
    if (placement.T_world_base) {
      track.z[i] = placement.T_world_base->translation().z();
      lift_m = track.z[i] - route_z;
    }
    const bool is_tilt_possible = placement.verdict != Verdict::kTooSteep;
    track.climb.push_back(is_tilt_possible ? placement.pitch_rad : 0.0);
    track.bank.push_back(is_tilt_possible ? placement.roll_rad : 0.0);
  }
}

std::vector<double> times(const Track& track, const Gait& gait) {
  std::vector<double> time_s{gait.start_s};
  for (std::size_t i = 1; i < track.size(); ++i) {
    const double way_m = std::hypot(track.x[i] - track.x[i - 1], track.y[i] - track.y[i - 1],
                                    track.z[i] - track.z[i - 1]);
    const double turn_rad = std::abs(track.yaw[i] - track.yaw[i - 1]);
    constexpr double kLeastS = 1e-6;
    time_s.push_back(time_s.back() +
                     std::max({way_m / gait.speed_m_s, turn_rad / gait.turn_rad_s, kLeastS}));
  }
  return time_s;
}

Eigen::Quaterniond attitude_of(const Track& track, std::size_t i) {
  return Eigen::AngleAxisd(track.yaw[i], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(track.climb[i], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(track.bank[i], Eigen::Vector3d::UnitX());
}

Track track_of(const Caster& caster, const Vehicle& vehicle, const Route& route, const Gait& gait) {
  const double sigma = gait.smoothing_m / kSpacingM;
  Track track = spread_evenly(route);
  track.x = smoothed(track.x, sigma);
  track.y = smoothed(track.y, sigma);
  track.z = smoothed(track.z, sigma);
  track.yaw = directions(track, gait.yaw_rad);
  rest_on_ground(caster, vehicle, track);
  // The ground's bumps are smaller than the way's corners.
  track.z = smoothed(track.z, 0.3 * sigma);
  track.climb = smoothed(track.climb, 0.5 * sigma);
  track.bank = smoothed(track.bank, 0.5 * sigma);
  return track;
}

}  // namespace

BodyMotion::BodyMotion(const Caster& caster, const Vehicle& vehicle, const Route& route,
                       const Gait& gait) {
  assert(!route.empty() && gait.speed_m_s > 0.0 && gait.turn_rad_s > 0.0);
  const Track track = track_of(caster, vehicle, route, gait);
  const std::vector<double> time_s = times(track, gait);
  for (std::size_t i = 0; i < track.size(); ++i)
    samples_.push_back({time_s[i], {track.x[i], track.y[i], track.z[i]}, attitude_of(track, i)});
}

Eigen::Isometry3d BodyMotion::T_world_base(double time_s) const {
  const auto after = std::ranges::upper_bound(samples_, time_s, {}, &Sample::time_s);
  const Sample& next = after == samples_.end() ? samples_.back() : *after;
  const Sample& last = after == samples_.begin() ? samples_.front() : *(after - 1);
  const double span_s = next.time_s - last.time_s;
  const double share = span_s > 0.0 ? (time_s - last.time_s) / span_s : 0.0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = last.position + share * (next.position - last.position);
  T.linear() = last.attitude.slerp(share, next.attitude).toRotationMatrix();
  return T;
}

Eigen::Isometry3d sensor_mount(const Vehicle& vehicle, double tilt_rad) {
  Eigen::Isometry3d T_base_sensor(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY()));
  T_base_sensor.translation().z() = vehicle.sensor_height_m;
  return T_base_sensor;
}

}  // namespace warren::world
