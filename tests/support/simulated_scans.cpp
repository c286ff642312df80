// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulated_scans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace warren::test {
namespace {

// Distance from inside the box to its wall along one axis.
float to_wall(float origin, float direction, float half) {
  if (direction == 0.0F) return std::numeric_limits<float>::infinity();
  return ((direction > 0.0F ? half : -half) - origin) / direction;
}

// Distance to an upright cylinder, infinite if the ray misses it.
float to_column(const Room& room, const Point3f& origin, const Point3f& direction) {
  const float dx = origin.x - room.column_x_m;
  const float dy = origin.y - room.column_y_m;
  const float a = direction.x * direction.x + direction.y * direction.y;
  const float b = dx * direction.x + dy * direction.y;
  const float c = dx * dx + dy * dy - room.column_radius_m * room.column_radius_m;
  const float discriminant = b * b - a * c;
  if (!(discriminant > 0.0F) || b > 0.0F) return std::numeric_limits<float>::infinity();
  return (-b - std::sqrt(discriminant)) / a;
}

}  // namespace

SimulatedScan scan_room(const Room& room, const Lidar& lidar, const Point3f& origin,
                        std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, lidar.noise_m);
  SimulatedScan scan{origin, {}};
  for (int ring = 0; ring < lidar.rings; ++ring) {
    const float share = static_cast<float>(ring) / static_cast<float>(lidar.rings - 1);
    const float pitch = lidar.lowest_rad + share * (lidar.highest_rad - lidar.lowest_rad);
    for (int column = 0; column < lidar.columns; ++column) {
      const float yaw = 2.0F * std::numbers::pi_v<float> * static_cast<float>(column) /
                        static_cast<float>(lidar.columns);
      const Point3f direction{std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                              std::sin(pitch)};
      const float range = std::min({to_wall(origin.x, direction.x, room.half_size.x),
                                    to_wall(origin.y, direction.y, room.half_size.y),
                                    to_wall(origin.z, direction.z, room.half_size.z),
                                    to_column(room, origin, direction)}) +
                          noise(random);
      scan.points_layer.push_back({origin.x + range * direction.x, origin.y + range * direction.y,
                                   origin.z + range * direction.z});
    }
  }
  return scan;
}

std::vector<SimulatedScan> walk_through_room(const Room& room, const Lidar& lidar, int scans) {
  std::vector<SimulatedScan> walk;
  for (int i = 0; i < scans; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(std::max(1, scans - 1));
    const Point3f place{room.half_size.x * (1.4F * share - 0.7F), -room.half_size.y * 0.5F, 0.1F};
    walk.push_back(scan_room(room, lidar, place, static_cast<std::uint32_t>(i)));
  }
  return walk;
}

}  // namespace warren::test
