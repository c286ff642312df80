// SPDX-License-Identifier: Apache-2.0
#include "tools/world/shapes.hpp"

#include <cmath>
#include <functional>
#include <utility>

namespace warren::world {
namespace {

// A prism: a polygon in the x-z plane, counter-clockwise seen from -y, swept over the width in y.
// `across(point, side)` gives the corner; side is -1 (right of x) or +1 (left).
class Extrusion {
 public:
  using Corner = std::function<Eigen::Vector3f(const Eigen::Vector2d& xz, double side)>;
  Extrusion(TriangleMesh& mesh, Corner corner, Surface surface)
      : mesh_(mesh), corner_(std::move(corner)), surface_(surface) {}

  void skirt(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    mesh_.add_quad({corner_(a, -1), corner_(b, -1), corner_(b, 1), corner_(a, 1)}, surface_);
  }
  void caps_of_triangle(const std::array<Eigen::Vector2d, 3>& p) {
    mesh_.add_triangle(corner_(p[0], -1), corner_(p[1], -1), corner_(p[2], -1), surface_);
    mesh_.add_triangle(corner_(p[0], 1), corner_(p[2], 1), corner_(p[1], 1), surface_);
  }
  void caps(const std::array<Eigen::Vector2d, 4>& p) {
    caps_of_triangle({p[0], p[1], p[2]});
    caps_of_triangle({p[0], p[2], p[3]});
  }

 private:
  TriangleMesh& mesh_;
  Corner corner_;
  Surface surface_;
};

}  // namespace

TriangleMesh box(const Eigen::AlignedBox3d& extent, Surface surface) {
  TriangleMesh mesh;
  Extrusion body(
      mesh,
      [&extent](const Eigen::Vector2d& xz, double side) -> Eigen::Vector3f {
        const double y = side < 0 ? extent.min().y() : extent.max().y();
        return Eigen::Vector3d(xz.x(), y, xz.y()).cast<float>();
      },
      surface);
  const Eigen::Vector2d low(extent.min().x(), extent.min().z());
  const Eigen::Vector2d high(extent.max().x(), extent.max().z());
  const std::array<Eigen::Vector2d, 4> outline = {low, Eigen::Vector2d(high.x(), low.y()), high,
                                                  Eigen::Vector2d(low.x(), high.y())};
  for (std::size_t i = 0; i < 4; ++i) body.skirt(outline[(i + 1) % 4], outline[i]);
  body.caps(outline);
  return mesh;
}

double Ramp::length_m() const { return height_m / std::tan(angle_rad); }

TriangleMesh wedge(const Ramp& ramp) {
  TriangleMesh mesh;
  Extrusion body(
      mesh,
      [&ramp](const Eigen::Vector2d& xz, double side) -> Eigen::Vector3f {
        return Eigen::Vector3d(xz.x(), side * ramp.width_m / 2.0, xz.y()).cast<float>();
      },
      Surface::kRamp);
  const std::array<Eigen::Vector2d, 3> outline = {Eigen::Vector2d(0.0, 0.0),
                                                  Eigen::Vector2d(ramp.length_m(), 0.0),
                                                  Eigen::Vector2d(ramp.length_m(), ramp.height_m)};
  for (std::size_t i = 0; i < 3; ++i) body.skirt(outline[(i + 1) % 3], outline[i]);
  body.caps_of_triangle(outline);
  return mesh;
}

TriangleMesh solid_of(const Stairway& stairway) {
  TriangleMesh mesh;
  Extrusion body(
      mesh,
      [&stairway](const Eigen::Vector2d& xz, double side) -> Eigen::Vector3f {
        return stairway.at(xz.x(), side * stairway.width_m / 2.0, xz.y()).cast<float>();
      },
      Surface::kStairs);
  const double end = stairway.steps * stairway.run_m;
  for (std::uint32_t step = 0; step < stairway.steps; ++step) {
    const double near = step * stairway.run_m;
    const double far = (step + 1) * stairway.run_m;
    const double low = step * stairway.rise_m;
    const double high = (step + 1) * stairway.rise_m;
    body.skirt({near, low}, {near, high});  // riser
    body.skirt({near, high}, {far, high});  // tread
    body.skirt({far, 0.0}, {near, 0.0});
    body.caps({Eigen::Vector2d(near, 0.0), Eigen::Vector2d(far, 0.0), Eigen::Vector2d(far, high),
               Eigen::Vector2d(near, high)});
  }
  const double highest = stairway.steps * stairway.rise_m;
  body.skirt({end, highest}, {end, 0.0});
  return mesh;
}

TriangleMesh stepfield(const Stepfield& settings, Random& random) {
  TriangleMesh mesh;
  for (int row = 0; row < settings.rows; ++row) {
    for (int column = 0; column < settings.columns; ++column) {
      const Eigen::Vector3d corner(row * settings.pitch_m, column * settings.pitch_m, 0.0);
      // Whole quarters, as sawn timber has: 1/4 to 4/4 of the highest.
      const double height = settings.highest_m * (1.0 + random.below(4)) / 4.0;
      const Eigen::Vector3d size(settings.pitch_m, settings.pitch_m, height);
      mesh.append(box({corner, corner + size}, Surface::kStepfield));
    }
  }
  return mesh;
}

Eigen::Isometry3d upright(const Eigen::Vector3d& position, double yaw_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(position);
  pose.rotate(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  return pose;
}

double heading_rad(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

}  // namespace warren::world
