// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/world/mesh_measures.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <utility>

namespace warren::test {
namespace {

using world::Triangle;
using world::TriangleMesh;

bool is_closed(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[i];
      const std::uint32_t b = triangle[(i + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(),
                     [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

double volume_m3(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += mesh.vertices[a].cast<double>().dot(
        mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>()));
  return sum / 6.0;
}

bool is_closed(const TriangleMesh& mesh) { return is_closed(mesh.triangles); }

bool is_closed_in_space(const TriangleMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> places;
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& vertex : triangle) {
      const Eigen::Vector3f& v = mesh.vertices[vertex];
      vertex = places.try_emplace({v.x(), v.y(), v.z()}, static_cast<std::uint32_t>(places.size()))
                   .first->second;
    }
  }
  return is_closed(triangles);
}

bool is_same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices.size() == b.vertices.size() && a.triangles == b.triangles &&
         a.surfaces == b.surfaces &&
         std::memcmp(a.vertices.data(), b.vertices.data(),
                     a.vertices.size() * sizeof(Eigen::Vector3f)) == 0;
}

Eigen::Vector3d normal_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3d from = mesh.vertices[a].cast<double>();
  return (mesh.vertices[b].cast<double>() - from)
      .cross(mesh.vertices[c].cast<double>() - from)
      .normalized();
}

}  // namespace warren::test
