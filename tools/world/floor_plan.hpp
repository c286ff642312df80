// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

// A building as square columns of solid with air carved out of them: any number of storeys, exact
// planes, sharp edges.
class FloorPlan {
 public:
  FloorPlan(const Eigen::AlignedBox2d& extent, double cell_m);

  // Makes a box air. In plan it is rounded to whole cells; its heights are kept.
  void carve(const Eigen::AlignedBox3d& air);
  // Floors, walls and ceilings around all air, merged to as large rectangles as are easily found.
  TriangleMesh mesh() const;

 private:
  struct Span {  // of air in a column
    double low_m;
    double high_m;
  };
  using Column = std::vector<Span>;  // from below, apart from one another

  std::size_t index(int x, int y) const;
  const Column& column(int x, int y) const;  // solid outside
  static void add(Column& column, Span span);
  // What is air in `a` and solid in `b`.
  static Column difference(const Column& a, const Column& b);
  void add_level_faces(TriangleMesh& mesh) const;
  void add_walls(TriangleMesh& mesh) const;
  Eigen::Vector3f corner(double x, double y, double z_m) const;

  Eigen::Vector2d origin_;
  double cell_m_;
  int columns_x_;
  int columns_y_;
  std::vector<Column> columns_;
};

}  // namespace warren::world
