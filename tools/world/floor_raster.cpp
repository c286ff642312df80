// SPDX-License-Identifier: Apache-2.0
#include "tools/world/floor_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

namespace warren::world {
namespace {

constexpr double kNoFloor = std::numeric_limits<double>::quiet_NaN();
constexpr double kFloorNormalZ = 0.7;
constexpr std::array<std::array<int, 2>, 8> kAround = {
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

// Height of a triangle above a point in plan, if it is there.
std::optional<double> height_at(const std::array<Eigen::Vector3d, 3>& t, double x, double y) {
  const double area =
      (t[1].x() - t[0].x()) * (t[2].y() - t[0].y()) - (t[2].x() - t[0].x()) * (t[1].y() - t[0].y());
  if (std::abs(area) < 1e-9) return std::nullopt;
  double z = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& b = t[(i + 1) % 3];
    const Eigen::Vector3d& c = t[(i + 2) % 3];
    const double weight = ((b.x() - x) * (c.y() - y) - (c.x() - x) * (b.y() - y)) / area;
    if (weight < 0.0) return std::nullopt;
    z += weight * t[i].z();
  }
  return z;
}

}  // namespace

FloorRaster::FloorRaster(const TriangleMesh& mesh, const Settings& settings)
    : cell_m_(settings.cell_m) {
  const Eigen::AlignedBox3d bounds = mesh.bounds().cast<double>();
  origin_ = bounds.min().head<2>();
  width_ = static_cast<int>(std::ceil(bounds.sizes().x() / cell_m_));
  height_ = static_cast<int>(std::ceil(bounds.sizes().y() / cell_m_));
  find_floors(mesh, settings.headroom_m);
  find_clearances(settings.step_m);
}

std::size_t FloorRaster::index(int x, int y) const {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
         static_cast<std::size_t>(x);
}

Eigen::Vector2i FloorRaster::cell_of(const Eigen::Vector3d& position) const {
  return ((position.head<2>() - origin_) / cell_m_).array().floor().cast<int>();
}

Eigen::Vector3d FloorRaster::position(int x, int y) const {
  return {origin_.x() + (x + 0.5) * cell_m_, origin_.y() + (y + 0.5) * cell_m_,
          floor_z_m_[index(x, y)]};
}

std::optional<double> FloorRaster::floor_z(int x, int y) const {
  if (!contains(x, y) || std::isnan(floor_z_m_[index(x, y)])) return std::nullopt;
  return floor_z_m_[index(x, y)];
}

std::optional<double> FloorRaster::floor_z(const Eigen::Vector3d& position) const {
  const Eigen::Vector2i cell = cell_of(position);
  return floor_z(cell.x(), cell.y());
}

double FloorRaster::clearance_m(int x, int y) const {
  return contains(x, y) ? clearance_m_[index(x, y)] : 0.0;
}

double FloorRaster::clearance_m(const Eigen::Vector3d& position) const {
  const Eigen::Vector2i cell = cell_of(position);
  return clearance_m(cell.x(), cell.y());
}

void FloorRaster::find_floors(const TriangleMesh& mesh, double headroom_m) {
  struct Hit {
    double z_m;
    bool is_floor;
    bool operator<(const Hit& other) const { return z_m < other.z_m; }
  };
  std::vector<std::vector<Hit>> surfaces(index(0, height_));
  for (const Triangle& triangle : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> t;
    Eigen::AlignedBox3d bounds;
    for (std::size_t i = 0; i < 3; ++i)
      bounds.extend(t[i] = mesh.vertices[triangle[i]].cast<double>());
    const bool is_floor = (t[1] - t[0]).cross(t[2] - t[0]).normalized().z() > kFloorNormalZ;
    const Eigen::Vector2i low = cell_of(bounds.min());
    const Eigen::Vector2i high = cell_of(bounds.max());
    for (int y = low.y(); y <= std::min(high.y(), height_ - 1); ++y) {
      for (int x = low.x(); x <= std::min(high.x(), width_ - 1); ++x) {
        const auto z =
            height_at(t, origin_.x() + (x + 0.5) * cell_m_, origin_.y() + (y + 0.5) * cell_m_);
        if (z) surfaces[index(x, y)].push_back({*z, is_floor});
      }
    }
  }
  floor_z_m_.assign(surfaces.size(), kNoFloor);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    auto& column = surfaces[i];
    std::sort(column.begin(), column.end());
    for (std::size_t k = 0; k < column.size() && std::isnan(floor_z_m_[i]); ++k) {
      const bool has_headroom =
          k + 1 == column.size() || column[k + 1].z_m - column[k].z_m >= headroom_m;
      if (column[k].is_floor && has_headroom) floor_z_m_[i] = column[k].z_m;
    }
  }
}

// Dijkstra from all cells that border on a step or on nothing; eight neighbours.
void FloorRaster::find_clearances(double step_m) {
  using Open = std::tuple<double, int, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  clearance_m_.assign(floor_z_m_.size(), std::numeric_limits<double>::infinity());
  const auto lower = [&](int x, int y, double clearance_m) {
    if (clearance_m >= clearance_m_[index(x, y)]) return;
    clearance_m_[index(x, y)] = clearance_m;
    open.emplace(clearance_m, x, y);
  };
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto here = floor_z(x, y);
      if (!here) {
        lower(x, y, 0.0);
        continue;
      }
      for (const auto& [dx, dy] : kAround) {
        const auto there = floor_z(x + dx, y + dy);
        if (!there || std::abs(*here - *there) > step_m) lower(x, y, 0.5 * cell_m_);
      }
    }
  }
  while (!open.empty()) {
    const auto [clearance_m, x, y] = open.top();
    open.pop();
    if (clearance_m > clearance_m_[index(x, y)]) continue;
    for (const auto& [dx, dy] : kAround)
      if (contains(x + dx, y + dy))
        lower(x + dx, y + dy, clearance_m + cell_m_ * std::hypot(dx, dy));
  }
}

}  // namespace warren::world
