// SPDX-License-Identifier: Apache-2.0
#include "tools/world/body_box.hpp"

#include <array>
#include <cmath>

namespace warren::world {
namespace {

// Rays between points given in the base frame.
class BaseRays {
 public:
  BaseRays(const Caster& caster, const Eigen::Isometry3d& T_world_base)
      : caster_(caster), T_world_base_(T_world_base) {}

  bool hit(const Eigen::Vector3d& from_base, const Eigen::Vector3d& to_base) const {
    const Eigen::Vector3f from = (T_world_base_ * from_base).cast<float>();
    const Eigen::Vector3f to = (T_world_base_ * to_base).cast<float>();
    return caster_.is_occluded(from, to);
  }

 private:
  const Caster& caster_;
  const Eigen::Isometry3d& T_world_base_;
};

using Rectangle = std::array<Eigen::Vector2d, 4>;

Rectangle outline(const Vehicle& vehicle) {
  const double x = vehicle.body_length_m / 2.0;
  const double y = vehicle.body_width_m / 2.0;
  return {Eigen::Vector2d{x, y}, Eigen::Vector2d{x, -y}, Eigen::Vector2d{-x, -y},
          Eigen::Vector2d{-x, y}};
}

Eigen::Vector3d at(const Eigen::Vector2d& xy, double z) { return {xy.x(), xy.y(), z}; }

// Every side and both diagonals.
bool layer_hit(const BaseRays& rays, const Rectangle& corners, double z) {
  for (std::size_t first = 0; first < corners.size(); ++first)
    for (std::size_t second = first + 1; second < corners.size(); ++second)
      if (rays.hit(at(corners[first], z), at(corners[second], z))) return true;
  return false;
}

bool uprights_hit(const BaseRays& rays, const Rectangle& corners, double low, double high) {
  for (std::size_t corner = 0; corner < corners.size(); ++corner) {
    const Eigen::Vector2d side = (corners[corner] + corners[(corner + 1) % 4]) / 2.0;
    for (const Eigen::Vector2d& xy : {corners[corner], side})
      if (rays.hit(at(xy, low), at(xy, high))) return true;
  }
  return rays.hit({0.0, 0.0, low}, {0.0, 0.0, high});
}

}  // namespace

bool belly_touches(const Caster& caster, const Vehicle& vehicle,
                   const Eigen::Isometry3d& T_world_base) {
  const BaseRays rays(caster, T_world_base);
  const double x = vehicle.wheelbase_m / 2.0;
  const double y = vehicle.track_m / 2.0;
  const double z = vehicle.clearance_m;
  for (const double share : {-0.8, -0.4, 0.0, 0.4, 0.8})
    if (rays.hit({-x, share * y, z}, {x, share * y, z}) ||
        rays.hit({share * x, -y, z}, {share * x, y, z}))
      return true;
  return false;
}

bool body_touches(const Caster& caster, const Vehicle& vehicle,
                  const Eigen::Isometry3d& T_world_base) {
  constexpr double kLayerM = 0.15;
  const BaseRays rays(caster, T_world_base);
  const Rectangle corners = outline(vehicle);
  const double tall_m = vehicle.height_m - vehicle.clearance_m;
  const int layers = static_cast<int>(std::ceil(tall_m / kLayerM));
  for (int layer = 0; layer <= layers; ++layer)
    if (layer_hit(rays, corners, vehicle.clearance_m + tall_m * layer / layers)) return true;
  return uprights_hit(rays, corners, vehicle.clearance_m, vehicle.height_m);
}

}  // namespace warren::world
