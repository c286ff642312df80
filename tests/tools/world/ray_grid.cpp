// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/world/ray_grid.hpp"

#include <algorithm>
#include <cmath>

namespace warren::test {
namespace {

constexpr double kCell_m = 1.0;

template <typename Visit>
void for_cells(const Eigen::AlignedBox3d& box, Visit visit) {
  const auto cell = [](double x) { return static_cast<std::int32_t>(std::floor(x / kCell_m)); };
  for (std::int32_t x = cell(box.min().x()); x <= cell(box.max().x()); ++x)
    for (std::int32_t y = cell(box.min().y()); y <= cell(box.max().y()); ++y)
      visit(static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
            static_cast<std::uint32_t>(y));
}

std::optional<double> hit(const Eigen::Vector3d& from, const Eigen::Vector3d& way,
                          const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  const Eigen::Vector3d across = way.cross(c - a);
  const double determinant = (b - a).dot(across);
  if (std::abs(determinant) < 1e-12) return std::nullopt;
  const double u = (from - a).dot(across) / determinant;
  const Eigen::Vector3d q = (from - a).cross(b - a);
  const double v = way.dot(q) / determinant;
  if (u < 0.0 || v < 0.0 || u + v > 1.0) return std::nullopt;
  const double t = (c - a).dot(q) / determinant;
  return t < 0.0 || t > 1.0 ? std::nullopt : std::optional(t);
}

}  // namespace

RayGrid::RayGrid(const world::TriangleMesh& mesh) : mesh_(mesh) {
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t vertex : mesh.triangles[i])
      box.extend(mesh.vertices[vertex].cast<double>());
    for_cells(box, [&](std::uint64_t cell) { cells_[cell].push_back(i); });
  }
}

std::optional<double> RayGrid::first_hit(const Eigen::Vector3d& from,
                                         const Eigen::Vector3d& to) const {
  std::optional<double> first;
  Eigen::AlignedBox3d box(from);
  box.extend(to);
  for_cells(box, [&](std::uint64_t cell) {
    const auto found = cells_.find(cell);
    if (found == cells_.end()) return;
    for (const std::uint32_t i : found->second) {
      const auto& [a, b, c] = mesh_.triangles[i];
      const auto t = hit(from, to - from, mesh_.vertices[a].cast<double>(),
                         mesh_.vertices[b].cast<double>(), mesh_.vertices[c].cast<double>());
      if (t && (!first || *t < *first)) first = t;
    }
  });
  return first;
}

std::optional<double> RayGrid::down(const Eigen::Vector3d& from, double reach_m) const {
  const auto share = first_hit(from, from - reach_m * Eigen::Vector3d::UnitZ());
  if (!share) return std::nullopt;
  return *share * reach_m;
}

}  // namespace warren::test
