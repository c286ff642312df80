// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "tools/world/caster.hpp"

namespace warren::world {

// Upright, closed above and below.
struct Cylinder {
  Eigen::Vector3d foot;  // middle of the lower end
  double radius_m = 0.25;
  double height_m = 1.75;
};

// Range to the nearest cylinder along the ray, if any is nearer than ray.max_range_m. A ray that
// starts inside a cylinder does not see it.
std::optional<float> cast(std::span<const Cylinder> cylinders, const Ray& ray);

// A cylinder that moves: a person, or another robot.
struct MovingBody {
  std::function<Eigen::Vector3d(double time_s)> foot;  // on the floor
  double radius_m = 0.25;
  double height_m = 1.75;
  double appears_s = -std::numeric_limits<double>::infinity();  // not there before
};

// What stands in the rays' way besides the mesh.
class MovingBodies {
 public:
  void add(MovingBody body) { bodies_.push_back(std::move(body)); }
  bool empty() const { return bodies_.empty(); }
  // Where they are at a time.
  std::vector<Cylinder> at(double time_s) const;

 private:
  std::vector<MovingBody> bodies_;
};

}  // namespace warren::world
