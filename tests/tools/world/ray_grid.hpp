// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "tools/world/triangle_mesh.hpp"

namespace warren::test {

// Brute force: segments against the triangles (Moeller, Trumbore 1997) of the grid cells in plan
// that the segment's bounding box touches. Slow and plain, to judge the quick ones by.
class RayGrid {
 public:
  explicit RayGrid(const world::TriangleMesh& mesh);

  // Share of the way from one point to another at the first surface between them.
  std::optional<double> first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  // Metres straight down to a surface.
  std::optional<double> down(const Eigen::Vector3d& from, double reach_m) const;

 private:
  const world::TriangleMesh& mesh_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace warren::test
