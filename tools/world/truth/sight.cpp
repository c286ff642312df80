// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/sight.hpp"

#include <algorithm>
#include <cmath>

namespace warren::world {

Field field_of(const LidarModel& lidar, double max_range_m) {
  return {.max_range_m = max_range_m,
          .lowest_rad = static_cast<double>(lidar.elevations_rad.back()),
          .highest_rad = static_cast<double>(lidar.elevations_rad.front())};
}

std::vector<Eigen::Isometry3d> viewpoints_of(const Simulation& simulation, std::size_t robot,
                                             double spacing_m) {
  const BodyMotion& motion = simulation.motion(robot);
  const double step_s = spacing_m / simulation.spec().robots[robot].speed_m_s;
  const Eigen::Isometry3d T_base_sensor = simulation.T_base_sensor(robot);
  std::vector<Eigen::Isometry3d> viewpoints;
  for (int step = 0; motion.start_s() + step * step_s <= simulation.spec().duration_s; ++step) {
    const Eigen::Isometry3d T_world_sensor =
        motion.T_world_base(motion.start_s() + step * step_s) * T_base_sensor;
    const bool has_moved = viewpoints.empty() || !T_world_sensor.isApprox(viewpoints.back(), 1e-9);
    if (has_moved) viewpoints.push_back(T_world_sensor);
  }
  return viewpoints;
}

Sight::Sight(const Caster& caster, std::span<const Eigen::Isometry3d> viewpoints,
             const Field& field, double skin_m)
    : caster_(caster),
      max_range_m_(static_cast<float>(field.max_range_m)),
      lowest_sine_(static_cast<float>(std::sin(field.lowest_rad))),
      highest_sine_(static_cast<float>(std::sin(field.highest_rad))),
      skin_m_(static_cast<float>(skin_m)) {
  for (const Eigen::Isometry3d& T : viewpoints)
    eyes_.push_back({T.translation().cast<float>(), T.linear().col(2).cast<float>()});
}

bool Sight::sees(const Eigen::Vector3f& point) const {
  return std::ranges::any_of(eyes_, [&](const Eye& eye) { return sees_from(eye, point); });
}

bool Sight::sees_from(const Eye& eye, const Eigen::Vector3f& point) const {
  const Eigen::Vector3f way = point - eye.position;
  const float range_m = way.norm();
  if (range_m > max_range_m_) return false;
  if (range_m <= skin_m_) return true;
  const float sine = way.dot(eye.up) / range_m;
  if (sine < lowest_sine_ || sine > highest_sine_) return false;
  return !caster_.is_occluded(Ray{eye.position, way / range_m, range_m - skin_m_});
}

}  // namespace warren::world
