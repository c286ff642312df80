// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "tools/world/caster.hpp"
#include "tools/world/vehicle.hpp"

namespace warren::world {

// Can a vehicle stand at a point of the ground, and move on from there? Tried out with its body on
// the mesh, at several headings. No normal, plane or curvature is computed, so that costs that come
// from those can be judged by it.
struct Drivability {
  double stand = 0.0;  // share of the headings at which it can stand
  double move = 0.0;   // share at which it can also go one step ahead
};

struct DrivabilityTest {
  int headings = 8;
  double step_m = 0.3;
};

// Every surface that faces up, on a grid of multiples of the spacing within a region; floors that
// lie above each other all count.
std::vector<Eigen::Vector3d> ground_points(const Caster& caster, const Eigen::AlignedBox3d& region,
                                           double spacing_m);

Drivability drivability_at(const Caster& caster, const Vehicle& vehicle,
                           const Eigen::Vector3d& ground, const DrivabilityTest& test = {});

struct GroundTruth {
  Eigen::Vector3d position;
  std::vector<Drivability> by_vehicle;  // in the vehicles' order
};
std::vector<GroundTruth> label_ground(const Caster& caster, std::span<const Vehicle> vehicles,
                                      const Eigen::AlignedBox3d& region, double spacing_m);

}  // namespace warren::world
