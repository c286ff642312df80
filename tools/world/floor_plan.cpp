// SPDX-License-Identifier: Apache-2.0
#include "tools/world/floor_plan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>
#include <utility>

namespace warren::world {
namespace {

// A piece of floor or ceiling: cells from..to in x, and in y.
struct LevelFace {
  double z_m;
  bool faces_up;
  int y_from;
  int y_to;
  int x_from;
  int x_to;
};

// A piece of wall on a grid line across `axis`, facing its air.
struct Wall {
  int axis;
  int line;
  bool faces_up_axis;  // the air is on the side of higher coordinates
  double low_m;
  double high_m;
  int from;  // along the other axis
  int to;
};

// Joins neighbours in a sorted list: `extend(last, next)` makes one of both or says no.
template <typename Face, typename Extend>
std::vector<Face> joined(const std::vector<Face>& faces, Extend extend) {
  std::vector<Face> all;
  for (const Face& face : faces)
    if (all.empty() || !extend(all.back(), face)) all.push_back(face);
  return all;
}

std::vector<LevelFace> merged(std::vector<LevelFace> faces) {
  const auto by_row = [](const LevelFace& a, const LevelFace& b) {
    return std::tie(a.z_m, a.faces_up, a.y_from, a.x_from) <
           std::tie(b.z_m, b.faces_up, b.y_from, b.x_from);
  };
  std::sort(faces.begin(), faces.end(), by_row);
  faces = joined(faces, [](LevelFace& a, const LevelFace& b) {
    const bool fits = std::tie(a.z_m, a.faces_up, a.y_from, a.x_to) ==
                      std::tie(b.z_m, b.faces_up, b.y_from, b.x_from);
    if (fits) a.x_to = b.x_to;
    return fits;
  });
  const auto by_width = [](const LevelFace& a, const LevelFace& b) {
    return std::tie(a.z_m, a.faces_up, a.x_from, a.x_to, a.y_from) <
           std::tie(b.z_m, b.faces_up, b.x_from, b.x_to, b.y_from);
  };
  std::sort(faces.begin(), faces.end(), by_width);
  return joined(faces, [](LevelFace& a, const LevelFace& b) {
    const bool fits = std::tie(a.z_m, a.faces_up, a.x_from, a.x_to, a.y_to) ==
                      std::tie(b.z_m, b.faces_up, b.x_from, b.x_to, b.y_from);
    if (fits) a.y_to = b.y_to;
    return fits;
  });
}

std::vector<Wall> merged(std::vector<Wall> walls) {
  const auto key = [](const Wall& wall) {
    return std::tie(wall.axis, wall.line, wall.faces_up_axis, wall.low_m, wall.high_m);
  };
  std::sort(walls.begin(), walls.end(), [&key](const Wall& a, const Wall& b) {
    return key(a) == key(b) ? a.from < b.from : key(a) < key(b);
  });
  return joined(walls, [&key](Wall& a, const Wall& b) {
    const bool fits = key(a) == key(b) && a.to == b.from;
    if (fits) a.to = b.to;
    return fits;
  });
}

}  // namespace

FloorPlan::FloorPlan(const Eigen::AlignedBox2d& extent, double cell_m)
    : origin_(extent.min()),
      cell_m_(cell_m),
      columns_x_(static_cast<int>(std::ceil(extent.sizes().x() / cell_m))),
      columns_y_(static_cast<int>(std::ceil(extent.sizes().y() / cell_m))),
      columns_(static_cast<std::size_t>(columns_x_) * static_cast<std::size_t>(columns_y_)) {}

std::size_t FloorPlan::index(int x, int y) const {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_x_) +
         static_cast<std::size_t>(x);
}

const FloorPlan::Column& FloorPlan::column(int x, int y) const {
  static const Column kSolid;
  if (x < 0 || y < 0 || x >= columns_x_ || y >= columns_y_) return kSolid;
  return columns_[index(x, y)];
}

void FloorPlan::add(Column& column, Span span) {
  const auto touches = [&span](const Span& other) {
    return other.low_m <= span.high_m && span.low_m <= other.high_m;
  };
  for (const Span& other : column) {
    if (!touches(other)) continue;
    span.low_m = std::min(span.low_m, other.low_m);
    span.high_m = std::max(span.high_m, other.high_m);
  }
  std::erase_if(column, touches);
  const auto above = [&span](const Span& other) { return other.low_m > span.high_m; };
  column.insert(std::find_if(column.begin(), column.end(), above), span);
}

FloorPlan::Column FloorPlan::difference(const Column& a, const Column& b) {
  Column rest = a;
  for (const Span& cut : b) {
    Column next;
    for (const Span& span : rest) {
      const Span below{span.low_m, std::min(span.high_m, cut.low_m)};
      const Span above{std::max(span.low_m, cut.high_m), span.high_m};
      if (below.low_m < below.high_m) next.push_back(below);
      if (above.low_m < above.high_m) next.push_back(above);
    }
    rest = next;
  }
  return rest;
}

void FloorPlan::carve(const Eigen::AlignedBox3d& air) {
  const auto cell = [this](double coordinate_m, double origin_m) {
    return static_cast<int>(std::lround((coordinate_m - origin_m) / cell_m_));
  };
  const int x_to = cell(air.max().x(), origin_.x());
  const int y_to = cell(air.max().y(), origin_.y());
  assert(x_to <= columns_x_ && y_to <= columns_y_);
  for (int y = cell(air.min().y(), origin_.y()); y < y_to; ++y) {
    for (int x = cell(air.min().x(), origin_.x()); x < x_to; ++x) {
      assert(x >= 0 && y >= 0);
      add(columns_[index(x, y)], {air.min().z(), air.max().z()});
    }
  }
}

Eigen::Vector3f FloorPlan::corner(double x, double y, double z_m) const {
  return Eigen::Vector3d(origin_.x() + x * cell_m_, origin_.y() + y * cell_m_, z_m).cast<float>();
}

void FloorPlan::add_level_faces(TriangleMesh& mesh) const {
  std::vector<LevelFace> faces;
  for (int y = 0; y < columns_y_; ++y) {
    for (int x = 0; x < columns_x_; ++x) {
      for (const Span& span : column(x, y)) {
        faces.push_back({span.low_m, true, y, y + 1, x, x + 1});
        faces.push_back({span.high_m, false, y, y + 1, x, x + 1});
      }
    }
  }
  for (const LevelFace& face : merged(std::move(faces))) {
    const Eigen::Vector3f a = corner(face.x_from, face.y_from, face.z_m);
    const Eigen::Vector3f b = corner(face.x_to, face.y_from, face.z_m);
    const Eigen::Vector3f c = corner(face.x_to, face.y_to, face.z_m);
    const Eigen::Vector3f d = corner(face.x_from, face.y_to, face.z_m);
    if (face.faces_up)
      mesh.add_quad({a, b, c, d}, Surface::kFloor);
    else
      mesh.add_quad({a, d, c, b}, Surface::kCeiling);
  }
}

void FloorPlan::add_walls(TriangleMesh& mesh) const {
  std::vector<Wall> walls;
  for (int y = 0; y <= columns_y_; ++y) {
    for (int x = 0; x <= columns_x_; ++x) {
      const Column& here = column(x, y);
      const Column& west = column(x - 1, y);
      const Column& south = column(x, y - 1);
      for (const Span& s : difference(here, west))
        walls.push_back({0, x, true, s.low_m, s.high_m, y, y + 1});
      for (const Span& s : difference(west, here))
        walls.push_back({0, x, false, s.low_m, s.high_m, y, y + 1});
      for (const Span& s : difference(here, south))
        walls.push_back({1, y, true, s.low_m, s.high_m, x, x + 1});
      for (const Span& s : difference(south, here))
        walls.push_back({1, y, false, s.low_m, s.high_m, x, x + 1});
    }
  }
  for (const Wall& wall : merged(std::move(walls))) {
    const auto at = [&](int along, double z_m) {
      return wall.axis == 0 ? corner(wall.line, along, z_m) : corner(along, wall.line, z_m);
    };
    // From..to and then up faces +x on lines across x, but -y on lines across y.
    const bool forward = wall.faces_up_axis == (wall.axis == 0);
    const int first = forward ? wall.from : wall.to;
    const int last = forward ? wall.to : wall.from;
    mesh.add_quad({at(first, wall.low_m), at(last, wall.low_m), at(last, wall.high_m),
                   at(first, wall.high_m)},
                  Surface::kWall);
  }
}

TriangleMesh FloorPlan::mesh() const {
  TriangleMesh mesh;
  add_level_faces(mesh);
  add_walls(mesh);
  return mesh;
}

}  // namespace warren::world
