// SPDX-License-Identifier: Apache-2.0
#include "tools/world/triangle_mesh.hpp"

#include <cassert>

namespace warren::world {

const char* name_of(Surface surface) {
  static constexpr std::array<const char*, kSurfaceCount> kNames = {
      "rock",    "floor",  "wall",      "ceiling", "stairs", "ramp",    "rail",
      "boulder", "rubble", "stepfield", "cable",   "fence",  "imported"};
  const auto index = static_cast<std::size_t>(surface);
  assert(index < kSurfaceCount);
  return kNames[index];
}

void TriangleMesh::append(const TriangleMesh& other, const Eigen::Isometry3d& T_world_mesh) {
  assert(other.surfaces.size() == other.triangles.size());
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (const Eigen::Vector3f& vertex : other.vertices)
    vertices.emplace_back((T_world_mesh * vertex.cast<double>()).cast<float>());
  for (const Triangle& triangle : other.triangles)
    triangles.push_back({first + triangle[0], first + triangle[1], first + triangle[2]});
  surfaces.insert(surfaces.end(), other.surfaces.begin(), other.surfaces.end());
}

void TriangleMesh::add_triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                const Eigen::Vector3f& c, Surface surface) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), {a, b, c});
  triangles.push_back({first, first + 1, first + 2});
  surfaces.push_back(surface);
}

void TriangleMesh::add_quad(const std::array<Eigen::Vector3f, 4>& corners, Surface surface) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), corners.begin(), corners.end());
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
  surfaces.insert(surfaces.end(), 2, surface);
}

Eigen::AlignedBox3f TriangleMesh::bounds() const {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : vertices) box.extend(vertex);
  return box;
}

}  // namespace warren::world
