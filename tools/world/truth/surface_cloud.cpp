// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/surface_cloud.hpp"

#include <cassert>
#include <cmath>

namespace warren::world {
namespace {

struct Corners {
  Eigen::Vector3f a;
  Eigen::Vector3f to_b;
  Eigen::Vector3f to_c;

  double area_m2() const { return 0.5 * static_cast<double>(to_b.cross(to_c).norm()); }
};

Corners corners_of(const TriangleMesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3f& a = mesh.vertices[triangle[0]];
  return {a, mesh.vertices[triangle[1]] - a, mesh.vertices[triangle[2]] - a};
}

Eigen::Vector3f anywhere_on(const Corners& corners, Random& random) {
  double b = random.uniform(0.0, 1.0);
  double c = random.uniform(0.0, 1.0);
  if (b + c > 1.0) {  // the other half of the parallelogram, folded back
    b = 1.0 - b;
    c = 1.0 - c;
  }
  return corners.a + static_cast<float>(b) * corners.to_b + static_cast<float>(c) * corners.to_c;
}

}  // namespace

std::vector<SurfaceSample> sample_surface(const TriangleMesh& mesh, double spacing_m,
                                          Random random) {
  assert(spacing_m > 0.0);
  std::vector<SurfaceSample> samples;
  double due = random.uniform(0.0, 1.0);  // samples that the area so far has earned
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners corners = corners_of(mesh, mesh.triangles[i]);
    due += corners.area_m2() / (spacing_m * spacing_m);
    while (due >= 1.0) {
      samples.push_back({anywhere_on(corners, random), mesh.surfaces[i]});
      due -= 1.0;
    }
  }
  return samples;
}

}  // namespace warren::world
