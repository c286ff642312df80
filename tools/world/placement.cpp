// SPDX-License-Identifier: Apache-2.0
#include "tools/world/placement.hpp"

#include <array>
#include <cmath>

#include "tools/world/body_box.hpp"

namespace warren::world {
namespace {

// Front left, front right, rear left, rear right; in wheelbases ahead and tracks to the left.
const std::array<Eigen::Vector2d, 4> kWheels{Eigen::Vector2d{0.5, 0.5}, Eigen::Vector2d{0.5, -0.5},
                                             Eigen::Vector2d{-0.5, 0.5},
                                             Eigen::Vector2d{-0.5, -0.5}};

struct Attitude {
  double z_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double warp_m = 0.0;
};

// A tilted vehicle's wheels are closer together, seen from above.
Eigen::Array2d spread_of(const Vehicle& vehicle, const Attitude& tilt) {
  return {vehicle.wheelbase_m * std::cos(tilt.pitch_rad),
          vehicle.track_m * std::cos(tilt.roll_rad)};
}

// The plane nearest to the four corners of a rectangle has a closed form.
Attitude rest_on(const std::array<double, 4>& z, const Eigen::Array2d& spread) {
  const double climb = (z[0] + z[1] - z[2] - z[3]) / (2.0 * spread.x());
  const double bank = (z[0] + z[2] - z[1] - z[3]) / (2.0 * spread.y());
  const double pitch_rad = -std::atan(climb);
  return {.z_m = (z[0] + z[1] + z[2] + z[3]) / 4.0,
          .roll_rad = std::atan(bank * std::cos(pitch_rad)),
          .pitch_rad = pitch_rad,
          .warp_m = std::abs(z[0] - z[1] - z[2] + z[3]) / 4.0};
}

// The contacts move together as the vehicle tilts: two rounds are enough for a centimetre.
Contact::Kind settle(const WheelContacts& contacts, const Vehicle& vehicle, const Stand& stand,
                     Attitude& attitude) {
  const Eigen::Rotation2Dd heading(stand.yaw_rad);
  for (int round = 0; round < 2; ++round) {
    const Eigen::Array2d spread = spread_of(vehicle, attitude);
    std::array<double, 4> z{};
    for (std::size_t wheel = 0; wheel < z.size(); ++wheel) {
      const Eigen::Vector2d offset = (kWheels[wheel].array() * spread).matrix();
      const Contact contact =
          contacts.wheel(Eigen::Vector2d(stand.x_m, stand.y_m) + heading * offset);
      if (contact.kind != Contact::Kind::kGround) return contact.kind;
      z[wheel] = contact.z_m;
    }
    attitude = rest_on(z, spread);
  }
  return Contact::Kind::kGround;
}

Eigen::Isometry3d pose_of(const Stand& stand, const Attitude& attitude) {
  Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
  T_world_base.translation() = Eigen::Vector3d(stand.x_m, stand.y_m, attitude.z_m);
  T_world_base.linear() = (Eigen::AngleAxisd(stand.yaw_rad, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(attitude.pitch_rad, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(attitude.roll_rad, Eigen::Vector3d::UnitX()))
                              .toRotationMatrix();
  return T_world_base;
}

Verdict judge(const Caster& caster, const Vehicle& vehicle, const Attitude& attitude,
              const Eigen::Isometry3d& T_world_base) {
  if (std::abs(attitude.pitch_rad) > vehicle.max_pitch_rad ||
      std::abs(attitude.roll_rad) > vehicle.max_roll_rad)
    return Verdict::kTooSteep;
  if (attitude.warp_m > vehicle.max_warp_m) return Verdict::kRocking;
  if (belly_touches(caster, vehicle, T_world_base)) return Verdict::kHighCentred;
  if (body_touches(caster, vehicle, T_world_base)) return Verdict::kBlocked;
  return Verdict::kOk;
}

}  // namespace

const char* name_of(Verdict verdict) {
  constexpr std::array kNames{"ok", "no_ground", "too_steep", "rocking", "high_centred", "blocked"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

Placement place(const Caster& caster, const Vehicle& vehicle, const Stand& stand) {
  const WheelContacts contacts(caster, vehicle, stand);
  Attitude attitude;
  const Contact::Kind found = settle(contacts, vehicle, stand, attitude);
  if (found == Contact::Kind::kBlocked) return {.verdict = Verdict::kBlocked};
  if (found == Contact::Kind::kNothing) return {.verdict = Verdict::kNoGround};
  const Eigen::Isometry3d T_world_base = pose_of(stand, attitude);
  return {.verdict = judge(caster, vehicle, attitude, T_world_base),
          .T_world_base = T_world_base,
          .roll_rad = attitude.roll_rad,
          .pitch_rad = attitude.pitch_rad};
}

}  // namespace warren::world
