// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

// A solid as a function: below zero is air, above is rock.
class SurfaceField {
 public:
  virtual ~SurfaceField() = default;
  virtual double value(const Eigen::Vector3d& position) const = 0;
  // False if the field has one sign within the ball. An error costs a piece of surface only if all
  // of that piece's neighbourhood is wrong as well.
  virtual bool may_cross(const Eigen::Vector3d& centre, double radius_m) const = 0;
};

// The zero surface within the boxes as triangles, counter-clockwise seen from the air: naive
// surface nets (Gibson 1998), the mean of a cell's edge crossings as its vertex. Watertight if the
// boxes hold the whole surface with two cells to spare. All triangles are kRock.
TriangleMesh surface_nets(const SurfaceField& field, const std::vector<Eigen::AlignedBox3d>& boxes,
                          double cell_m);

}  // namespace warren::world
