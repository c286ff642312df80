// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

// The lowest floor with headroom in every cell of a grid in plan, and the distance from each cell
// to the nearest one where nobody could go on.
class FloorRaster {
 public:
  struct Settings {
    double cell_m = 0.5;
    double headroom_m = 1.4;
    double step_m = 0.3;
  };
  FloorRaster(const TriangleMesh& mesh, const Settings& settings);

  int width() const { return width_; }
  int height() const { return height_; }
  Eigen::Vector3d position(int x, int y) const;  // cell's middle, on its floor
  // None outside and where there is no floor.
  std::optional<double> floor_z(int x, int y) const;
  std::optional<double> floor_z(const Eigen::Vector3d& position) const;
  double clearance_m(int x, int y) const;
  double clearance_m(const Eigen::Vector3d& position) const;

 private:
  std::size_t index(int x, int y) const;
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  Eigen::Vector2i cell_of(const Eigen::Vector3d& position) const;
  void find_floors(const TriangleMesh& mesh, double headroom_m);
  void find_clearances(double step_m);

  double cell_m_;
  Eigen::Vector2d origin_;
  int width_;
  int height_;
  std::vector<double> floor_z_m_;  // NaN: none
  std::vector<double> clearance_m_;
};

}  // namespace warren::world
