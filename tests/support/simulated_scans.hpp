// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/voxel/scan.hpp"

namespace warren::test {

struct SimulatedScan {
  Point3f origin_layer;
  std::vector<Point3f> points_layer;

  LayerScan view(std::optional<double> max_range_m = std::nullopt) const {
    return {origin_layer, points_layer, max_range_m, {}};
  }
};

// A box-shaped room with an upright column in it, seen by a spinning lidar.
struct Room {
  Point3f half_size{6.0F, 4.0F, 1.5F};
  float column_radius_m = 0.4F;
  // Where the column stands; none if not finite.
  float column_x_m = 2.0F;
  float column_y_m = 1.0F;
};

struct Lidar {
  int rings = 24;
  int columns = 180;
  float lowest_rad = -0.6F;
  float highest_rad = 0.6F;
  float noise_m = 0.01F;
};

// The scan of a room from a place in it; the same seed gives the same points.
SimulatedScan scan_room(const Room& room, const Lidar& lidar, const Point3f& origin,
                        std::uint32_t seed);

// Scans from places along a line through the room.
std::vector<SimulatedScan> walk_through_room(const Room& room, const Lidar& lidar, int scans);

}  // namespace warren::test
