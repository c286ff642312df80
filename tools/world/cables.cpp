// SPDX-License-Identifier: Apache-2.0
#include "tools/world/cables.hpp"

#include <cmath>
#include <numbers>

namespace warren::world {
namespace {

using Line = std::vector<Eigen::Vector3d>;

// Shape of a hanging chain over -1..1, 0 at the ends and 1 in the middle, for a sag of a given
// share of the span: the catenary's parameter c solves sag / span = (cosh c - 1) / (2 c).
class Catenary {
 public:
  explicit Catenary(double sag_of_span) {
    double low = 1e-6;
    double high = 10.0;
    for (int i = 0; i < 60; ++i) {
      const double c = (low + high) / 2.0;
      ((std::cosh(c) - 1.0) / (2.0 * c) < sag_of_span ? low : high) = c;
    }
    c_ = high;
  }
  double at(double u) const { return (std::cosh(c_) - std::cosh(c_ * u)) / (std::cosh(c_) - 1.0); }

 private:
  double c_;
};

Line hanging_line(const Cable& settings) {
  const double span_m = (settings.to - settings.from).norm();
  if (settings.sag_m <= 0.0) return {settings.from, settings.to};
  const Catenary shape(settings.sag_m / span_m);
  const int pieces = std::max(8, static_cast<int>(std::ceil(span_m / 0.5)));
  Line line;
  for (int i = 0; i <= pieces; ++i) {
    const double t = static_cast<double>(i) / pieces;
    const Eigen::Vector3d chord = settings.from + t * (settings.to - settings.from);
    line.push_back(chord - settings.sag_m * shape.at(2.0 * t - 1.0) * Eigen::Vector3d::UnitZ());
  }
  return line;
}

Eigen::Vector3d tangent(const Line& line, std::size_t i) {
  return (line[std::min(i + 1, line.size() - 1)] - line[i == 0 ? 0 : i - 1]).normalized();
}

void add_ring(TriangleMesh& mesh, const Eigen::Vector3d& centre, const Eigen::Vector3d& along,
              double radius_m, int sides) {
  // Any fixed direction that is not parallel will do; nearly all tubes are level or upright.
  const Eigen::Vector3d aside =
      std::abs(along.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d u = along.cross(aside).normalized();
  const Eigen::Vector3d v = along.cross(u);
  for (int side = 0; side < sides; ++side) {
    const double angle_rad = 2.0 * std::numbers::pi * side / sides;
    const Eigen::Vector3d out = std::cos(angle_rad) * u + std::sin(angle_rad) * v;
    mesh.vertices.emplace_back((centre + radius_m * out).cast<float>());
  }
}

}  // namespace

TriangleMesh tube(const Line& line, double radius_m, int sides, Surface surface) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < line.size(); ++i)
    add_ring(mesh, line[i], tangent(line, i), radius_m, sides);
  const auto count = static_cast<std::uint32_t>(sides);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size()) - count;
  for (std::uint32_t ring = 0; ring < last; ring += count) {
    for (std::uint32_t side = 0; side < count; ++side) {
      const std::uint32_t next = (side + 1) % count;
      const std::uint32_t a = ring + side;
      const std::uint32_t b = ring + next;
      mesh.triangles.push_back({a, b, b + count});
      mesh.triangles.push_back({a, b + count, a + count});
    }
  }
  for (std::uint32_t side = 1; side + 1 < count; ++side) {
    mesh.triangles.push_back({0, side + 1, side});
    mesh.triangles.push_back({last, last + side, last + side + 1});
  }
  mesh.surfaces.assign(mesh.triangles.size(), surface);
  return mesh;
}

TriangleMesh cable(const Cable& settings) {
  return tube(hanging_line(settings), settings.radius_m, 6, Surface::kCable);
}

TriangleMesh fence(const Fence& settings) {
  TriangleMesh mesh;
  const Eigen::Vector3d up = settings.height_m * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d along = settings.to - settings.from;
  const auto wire = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m) {
    mesh.append(tube({from, to}, radius_m, 3, Surface::kFence));
  };
  wire(settings.from, settings.from + up, 0.03);
  wire(settings.to, settings.to + up, 0.03);
  const int rows = static_cast<int>(settings.height_m / settings.mesh_m);
  for (int row = 1; row <= rows; ++row) {
    const Eigen::Vector3d lift = row * settings.mesh_m * Eigen::Vector3d::UnitZ();
    wire(settings.from + lift, settings.to + lift, settings.wire_m / 2.0);
  }
  const int columns = static_cast<int>(along.norm() / settings.mesh_m);
  for (int column = 1; column < columns; ++column) {
    const Eigen::Vector3d foot = settings.from + along * column / columns;
    wire(foot, foot + up, settings.wire_m / 2.0);
  }
  return mesh;
}

}  // namespace warren::world
