// SPDX-License-Identifier: Apache-2.0
#include "tools/world/triangle_mesh.hpp"

#include <set>
#include <string>

#include <doctest/doctest.h>

#include "tools/world/shapes.hpp"

namespace warren::world {

TEST_CASE("every surface has a name of its own") {
  std::set<std::string> names;
  for (std::size_t i = 0; i < kSurfaceCount; ++i) names.insert(name_of(static_cast<Surface>(i)));
  CHECK(names.size() == kSurfaceCount);
  CHECK(std::string(name_of(Surface::kImported)) == "imported");
}

TEST_CASE("a mesh appended with a pose is moved and keeps its triangles and surfaces") {
  TriangleMesh part;
  part.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Surface::kRamp);
  TriangleMesh whole = part;
  whole.append(part, upright({10.0, 0.0, 2.0}, 1.5707963267948966));
  REQUIRE(whole.triangles.size() == 2);
  CHECK(whole.triangles[1] == Triangle{3, 4, 5});
  CHECK(whole.surfaces[1] == Surface::kRamp);
  CHECK((whole.vertices[4] - Eigen::Vector3f(10, 1, 2)).norm() < 1e-6F);
  CHECK((whole.vertices[5] - Eigen::Vector3f(9, 0, 2)).norm() < 1e-6F);
}

TEST_CASE("the bounds hold all vertices") {
  TriangleMesh mesh;
  mesh.add_quad({Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(2, 0, 0), Eigen::Vector3f(2, 3, 0),
                 Eigen::Vector3f(0, 3, -1)},
                Surface::kFloor);
  CHECK(mesh.bounds().min() == Eigen::Vector3f(0, 0, -1));
  CHECK(mesh.bounds().max() == Eigen::Vector3f(2, 3, 0));
  CHECK(mesh.surfaces.size() == mesh.triangles.size());
}

}  // namespace warren::world
