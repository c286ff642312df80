// SPDX-License-Identifier: Apache-2.0
#include "tools/world/moving_bodies.hpp"

#include <algorithm>
#include <cmath>

namespace warren::world {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Ranges at which a line is inside a convex body; empty if first > last.
struct Interval {
  double first = -kInfinity;
  double last = kInfinity;

  Interval operator&(const Interval& other) const {
    return {std::max(first, other.first), std::min(last, other.last)};
  }
};
constexpr Interval kNever{kInfinity, -kInfinity};

// Between the planes of the two ends.
Interval inside_slab(double z, double direction_z, double height_m) {
  if (direction_z == 0.0) return z >= 0.0 && z <= height_m ? Interval{} : kNever;
  const double low = -z / direction_z;
  const double high = (height_m - z) / direction_z;
  return {std::min(low, high), std::max(low, high)};
}

// Within the endless cylinder about the z axis: |p + t d| <= radius is a quadratic in t.
Interval inside_round(const Eigen::Vector2d& p, const Eigen::Vector2d& d, double radius_m) {
  const double a = d.squaredNorm();
  const double c = p.squaredNorm() - radius_m * radius_m;
  if (a == 0.0) return c <= 0.0 ? Interval{} : kNever;
  const double half_b = p.dot(d);
  const double discriminant = half_b * half_b - a * c;
  if (discriminant < 0.0) return kNever;
  const double root = std::sqrt(discriminant);
  return {(-half_b - root) / a, (-half_b + root) / a};
}

double range_to(const Cylinder& cylinder, const Ray& ray) {
  const Eigen::Vector3d from = ray.origin.cast<double>() - cylinder.foot;
  const Eigen::Vector3d along = ray.direction.cast<double>();
  const Interval inside = inside_round(from.head<2>(), along.head<2>(), cylinder.radius_m) &
                          inside_slab(from.z(), along.z(), cylinder.height_m);
  return inside.first <= inside.last && inside.first >= 0.0 ? inside.first : kInfinity;
}

}  // namespace

std::optional<float> cast(std::span<const Cylinder> cylinders, const Ray& ray) {
  double nearest_m = kInfinity;
  for (const Cylinder& cylinder : cylinders)
    nearest_m = std::min(nearest_m, range_to(cylinder, ray));
  if (nearest_m >= static_cast<double>(ray.max_range_m)) return std::nullopt;
  return static_cast<float>(nearest_m);
}

std::vector<Cylinder> MovingBodies::at(double time_s) const {
  std::vector<Cylinder> cylinders;
  for (const MovingBody& body : bodies_)
    if (time_s >= body.appears_s)
      cylinders.push_back({body.foot(time_s), body.radius_m, body.height_m});
  return cylinders;
}

}  // namespace warren::world
