// SPDX-License-Identifier: Apache-2.0
#include "tools/world/rails.hpp"

#include <cmath>

#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

// How deep rails and sleepers reach below the line, so that a rough floor leaves no gap.
constexpr double kBedding_m = 0.2;

// A frame at a point of a piece of the line: x along it (with its slope), y to the left.
Eigen::Isometry3d frame(const Eigen::Vector3d& at, const Eigen::Vector3d& along) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(along).normalized();
  pose.linear().col(0) = along;
  pose.linear().col(1) = left;
  pose.linear().col(2) = along.cross(left);
  pose.translation() = at;
  return pose;
}

// A bar along x, centred on y, from below the floor to `top_m`.
TriangleMesh bar(double from_x_m, double to_x_m, double y_m, double width_m, double top_m) {
  const Eigen::Vector3d low(from_x_m, y_m - width_m / 2.0, -kBedding_m);
  const Eigen::Vector3d high(to_x_m, y_m + width_m / 2.0, top_m);
  return box({low, high}, Surface::kRail);
}

}  // namespace

TriangleMesh rails(const std::vector<Eigen::Vector3d>& line, const Rails& settings) {
  TriangleMesh mesh;
  double to_sleeper_m = settings.sleeper_every_m / 2.0;
  const double top_m = settings.sleeper_height_m + settings.rail_height_m;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length_m = (line[i + 1] - line[i]).norm();
    const Eigen::Isometry3d T = frame(line[i], (line[i + 1] - line[i]) / length_m);
    // Pieces overlap a little, or a bend would open a gap.
    for (const double side : {-0.5, 0.5})
      mesh.append(
          bar(-0.02, length_m + 0.02, side * settings.gauge_m, settings.rail_width_m, top_m), T);
    while (to_sleeper_m < length_m) {
      const double half_m = settings.sleeper_width_m / 2.0;
      mesh.append(bar(to_sleeper_m - half_m, to_sleeper_m + half_m, 0.0, settings.sleeper_length_m,
                      settings.sleeper_height_m),
                  T);
      to_sleeper_m += settings.sleeper_every_m;
    }
    to_sleeper_m -= length_m;
  }
  return mesh;
}

}  // namespace warren::world
