// SPDX-License-Identifier: Apache-2.0
#include "tools/world/wheel_contact.hpp"

#include <cmath>

namespace warren::world {
namespace {

// A wheel may stand this much higher or lower than the middle of the vehicle.
double reach_of(const Vehicle& vehicle) {
  return vehicle.max_step_m + 0.5 * vehicle.wheelbase_m * std::tan(vehicle.max_pitch_rad) +
         0.5 * vehicle.track_m * std::tan(vehicle.max_roll_rad);
}

Eigen::Vector3f point(const Eigen::Vector2d& xy, double z) {
  return {static_cast<float>(xy.x()), static_cast<float>(xy.y()), static_cast<float>(z)};
}

}  // namespace

WheelContacts::WheelContacts(const Caster& caster, const Vehicle& vehicle, const Stand& stand)
    : caster_(caster),
      middle_(stand.x_m, stand.y_m),
      ahead_(std::cos(stand.yaw_rad), std::sin(stand.yaw_rad)),
      near_z_m_(stand.near_z_m),
      wheel_radius_m_(vehicle.wheel_radius_m),
      reach_m_(reach_of(vehicle)) {
  for (const double share : {1.0, 0.5, 0.25}) add_eye_if_in_air(share * reach_m_);
}

// In the air, a ray down meets a surface from the side that it is seen from; in the rock above a
// low ceiling it does not. Over a gap it meets nothing, and the way up from the stand decides.
void WheelContacts::add_eye_if_in_air(double above_m) {
  const Eigen::Vector3f eye = point(middle_, near_z_m_ + above_m);
  const auto below = caster_.down(eye, static_cast<float>(above_m + reach_m_));
  const bool in_air =
      below ? below->normal.z() > 0.0F : !caster_.is_occluded(point(middle_, near_z_m_), eye);
  if (in_air) eyes_m_.push_back(near_z_m_ + above_m);
}

Contact WheelContacts::ground(const Eigen::Vector2d& xy) const {
  Contact::Kind failure = Contact::Kind::kBlocked;
  for (const double eye_m : eyes_m_) {
    if (caster_.is_occluded(point(middle_, eye_m), point(xy, eye_m))) continue;
    failure = Contact::Kind::kNothing;
    const double reach_m = eye_m - near_z_m_ + reach_m_;
    const auto below = caster_.down(point(xy, eye_m), static_cast<float>(reach_m));
    if (below) return {Contact::Kind::kGround, eye_m - static_cast<double>(below->range_m)};
  }
  return {failure, 0.0};
}

Contact WheelContacts::wheel(const Eigen::Vector2d& xy) const {
  Contact highest;
  for (const double share : {-0.6, 0.0, 0.6}) {
    const Contact found = ground(xy + share * wheel_radius_m_ * ahead_);
    if (found.kind == Contact::Kind::kBlocked) return found;
    if (found.kind == Contact::Kind::kNothing) continue;
    // Under a round wheel, ground off its middle has room before it touches.
    const double z_m = found.z_m - wheel_radius_m_ * (1.0 - std::sqrt(1.0 - share * share));
    if (highest.kind != Contact::Kind::kGround || z_m > highest.z_m)
      highest = {Contact::Kind::kGround, z_m};
  }
  return highest;
}

}  // namespace warren::world
