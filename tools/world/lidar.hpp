// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "core/voxel/point.hpp"
#include "tools/world/caster.hpp"
#include "tools/world/moving_bodies.hpp"
#include "tools/world/random.hpp"

namespace warren::world {

// A spinning lidar, clockwise seen from above, the first column next after straight ahead.
struct LidarModel {
  std::string name;                   // os1-64, os0-128, os1-128
  std::vector<float> elevations_rad;  // of the beams, top first
  std::uint32_t columns = 1024;
  double rate_hz = 10.0;
  float min_range_m = 0.3F;
  float max_range_m = 100.0F;
  float range_noise_m = 0.01F;  // standard deviation
  double dropout = 0.002;       // share of rays that return nothing for no reason

  double column_s() const { return 1.0 / (rate_hz * columns); }
};
std::optional<LidarModel> lidar_of(std::string_view name);
std::vector<std::string> lidar_names();

// T_world_sensor at a time, seconds.
using SensorMotion = std::function<Eigen::Isometry3d(double time_s)>;

struct Sweep {
  // Beam by beam within column by column: points[column * beams + beam], sensor frame, metres; NaN
  // where nothing came back.
  std::vector<Point3f> points_sensor;
  Eigen::Isometry3d T_world_sensor;  // at the end of the sweep: the frame of the points
  double end_s = 0.0;
};

enum class Deskew : std::uint8_t {
  kYes,  // every point in the frame of the sweep's end
  kNo,   // every point in the frame of its own column, as the sensor sent it
};

// Where and when rays are cast: the world during a sweep.
struct Surroundings {
  const Caster& caster;
  const MovingBodies& bodies;
};

// One turn whose last column is measured at `end_s`, the sensor moving all the while.
Sweep sweep(const Surroundings& surroundings, const LidarModel& model, const SensorMotion& motion,
            double end_s, Deskew deskew, Random& random);

}  // namespace warren::world
