// SPDX-License-Identifier: Apache-2.0
#include "tools/world/boulders.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tools/world/noise.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

struct Sphere {
  std::vector<Eigen::Vector3d> points;  // unit
  std::vector<Triangle> triangles;
};

Sphere icosahedron() {
  const double g = std::numbers::phi;
  Sphere sphere;
  // Three golden rectangles, one in each plane.
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      sphere.points.emplace_back(0.0, a, b);
      sphere.points.emplace_back(a, b, 0.0);
      sphere.points.emplace_back(b, 0.0, a);
    }
  }
  // The faces are the triples of mutual neighbours, all edges being 2 long.
  const auto is_edge = [&sphere](std::uint32_t i, std::uint32_t j) {
    return (sphere.points[i] - sphere.points[j]).squaredNorm() < 4.1;
  };
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint32_t j = i + 1; j < 12; ++j) {
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (!is_edge(i, j) || !is_edge(j, k) || !is_edge(i, k)) continue;
        const auto& p = sphere.points;
        const bool outward = (p[j] - p[i]).cross(p[k] - p[i]).dot(p[i]) > 0.0;
        sphere.triangles.push_back(outward ? Triangle{i, j, k} : Triangle{i, k, j});
      }
    }
  }
  for (Eigen::Vector3d& point : sphere.points) point.normalize();
  return sphere;
}

Sphere refined(const Sphere& coarse) {
  Sphere fine{coarse.points, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), fine.points.size());
    if (is_new) fine.points.push_back((fine.points[a] + fine.points[b]).normalized());
    return entry->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    fine.triangles.insert(fine.triangles.end(),
                          {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

Sphere sphere_of(int refinements) {
  Sphere sphere = icosahedron();
  for (int i = 0; i < refinements; ++i) sphere = refined(sphere);
  return sphere;
}

}  // namespace

TriangleMesh boulder(const Boulder& settings, Random& random) {
  const std::uint64_t seed = random.next();
  const Eigen::Vector3d squash(random.uniform(0.8, 1.1), random.uniform(0.8, 1.1),
                               random.uniform(0.6, 0.9));
  Sphere sphere = sphere_of(settings.refinements);
  TriangleMesh mesh;
  for (const Eigen::Vector3d& point : sphere.points) {
    const double bump = std::clamp(fractal_noise(1.3 * point, 3, seed), -1.0, 1.0);
    const double radius_m = settings.radius_m * (1.0 + settings.roughness * bump);
    mesh.vertices.emplace_back((radius_m * point.cwiseProduct(squash)).cast<float>());
  }
  mesh.triangles = std::move(sphere.triangles);
  mesh.surfaces.assign(mesh.triangles.size(), settings.surface);
  return mesh;
}

TriangleMesh rubble_pile(const RubblePile& settings, Random& random) {
  TriangleMesh mesh;
  for (int stone = 0; stone < settings.stones; ++stone) {
    const double out = std::sqrt(random.uniform(0.0, 1.0));
    const double azimuth_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double heap_m = settings.height_m * (1.0 - out);
    const double radius_m = random.uniform(0.06, 0.18) * std::min(1.0, settings.radius_m);
    const Eigen::Vector3d place(out * settings.radius_m * std::cos(azimuth_rad),
                                out * settings.radius_m * std::sin(azimuth_rad),
                                heap_m * random.uniform(0.4, 1.0));
    const Boulder shape{
        .radius_m = radius_m, .roughness = 0.35, .refinements = 1, .surface = Surface::kRubble};
    mesh.append(boulder(shape, random), upright(place, azimuth_rad));
  }
  return mesh;
}

}  // namespace warren::world
