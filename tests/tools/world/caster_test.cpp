// SPDX-License-Identifier: Apache-2.0
#include "tools/world/caster.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"
#include "tools/world/random.hpp"

using namespace warren::world;

namespace {

Eigen::Vector3f direction(Random& random) {
  Eigen::Vector3f v;
  do {
    for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<float>(random.uniform(-1.0, 1.0));
  } while (v.norm() > 1.0F || v.norm() < 0.1F);
  return v.normalized();
}

// Moller and Trumbore (1997), in double; infinity if there is no hit. `margin` is how far the hit
// lies within the triangle, in barycentric units.
struct Exact {
  double range_m = INFINITY;
  double margin = 0.0;
};
Exact moller_trumbore(const TriangleMesh& mesh, std::size_t index, const Ray& ray) {
  const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
    return mesh.vertices[mesh.triangles[index][i]].cast<double>();
  };
  const Eigen::Vector3d e1 = corner(1) - corner(0);
  const Eigen::Vector3d e2 = corner(2) - corner(0);
  const Eigen::Vector3d d = ray.direction.cast<double>();
  const Eigen::Vector3d p = d.cross(e2);
  const double determinant = e1.dot(p);
  if (determinant == 0.0) return {};
  const Eigen::Vector3d t = ray.origin.cast<double>() - corner(0);
  const Eigen::Vector3d q = t.cross(e1);
  const double u = t.dot(p) / determinant;
  const double v = d.dot(q) / determinant;
  const double range = e2.dot(q) / determinant;
  const double margin = std::min({u, v, 1.0 - u - v});
  return margin >= 0.0 && range >= 0.0 ? Exact{range, margin} : Exact{};
}

struct Nearest {
  Exact hit;
  std::size_t triangle = 0;
};
Nearest brute_force(const TriangleMesh& mesh, const Ray& ray) {
  Nearest nearest;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Exact hit = moller_trumbore(mesh, i, ray);
    if (hit.range_m < nearest.hit.range_m) nearest = {hit, i};
  }
  return nearest;
}

}  // namespace

TEST_CASE("a ray finds what a test of every triangle finds") {
  const TriangleMesh mesh = test::soup(300, 7);
  const Caster caster(mesh);
  Random random(11);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{6.0F * direction(random), direction(random)};
    const Nearest exact = brute_force(mesh, ray);
    const auto found = caster.cast(ray);
    CHECK(caster.is_occluded(ray) == found.has_value());
    if (std::isfinite(exact.hit.range_m) && exact.hit.margin < 1e-4) continue;  // either is right
    REQUIRE(found.has_value() == std::isfinite(exact.hit.range_m));
    if (!found) continue;
    ++hits;
    CHECK(static_cast<double>(found->range_m) == doctest::Approx(exact.hit.range_m).epsilon(1e-4));
    CHECK(found->triangle == exact.triangle);
    CHECK(caster.range_m(ray) == found->range_m);
  }
  CHECK(hits > 300);
}

TEST_CASE("the normal points to the side that the triangle is wound for") {
  const TriangleMesh mesh = test::soup(100, 3);
  const Caster caster(mesh);
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const auto found = caster.cast({6.0F * direction(random), direction(random)});
    if (!found) continue;
    const auto corner = [&](std::size_t k) {
      return mesh.vertices[mesh.triangles[found->triangle][k]];
    };
    const Eigen::Vector3f normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    CHECK((found->normal - normal.normalized()).norm() < 1e-4F);
  }
}

TEST_CASE("a ball of many triangles is as far as the sphere that it fills") {
  const TriangleMesh mesh = test::ball(2.0F, 100);
  const Caster caster(mesh);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f from = 5.0F * direction(random);
    const Eigen::Vector3f target = 1.5F * direction(random);
    const Eigen::Vector3f along = (target - from).normalized();
    const double half_b = static_cast<double>(from.dot(along));
    const double c = static_cast<double>(from.squaredNorm()) - 4.0;
    const double exact_m = -half_b - std::sqrt(half_b * half_b - c);
    const auto found = caster.cast({from, along});
    REQUIRE(found);
    CHECK(static_cast<double>(found->range_m) - exact_m < 0.002);
    CHECK(static_cast<double>(found->range_m) - exact_m > -1e-4);
    CHECK(found->normal.dot(along) < 0.0F);
  }
}

TEST_CASE("a room is as wide in every direction as its box") {
  const Eigen::Vector3f half(4.0F, 3.0F, 1.5F);
  const TriangleMesh mesh = test::room(half);
  const Caster caster(mesh);
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f along = direction(random);
    const Eigen::Vector3f from = half.cwiseProduct(0.9F * direction(random));
    float exact_m = INFINITY;
    for (int axis = 0; axis < 3; ++axis)
      if (along[axis] != 0.0F)
        exact_m =
            std::min(exact_m, (std::copysign(half[axis], along[axis]) - from[axis]) / along[axis]);
    const auto found = caster.cast({from, along});
    REQUIRE(found);
    CHECK(found->range_m == doctest::Approx(exact_m).epsilon(1e-4));
    CHECK(found->normal.dot(along) < 0.0F);
  }
}

TEST_CASE("a range limit hides what is beyond it") {
  const TriangleMesh mesh = test::flat(5.0);
  const Caster caster(mesh);
  const Eigen::Vector3f from(1.0F, 1.0F, 2.0F);
  CHECK(caster.down(from, 2.5F)->range_m == doctest::Approx(2.0));
  CHECK_FALSE(caster.down(from, 1.5F));
  CHECK(caster.is_occluded(from, Eigen::Vector3f(1.0F, 1.0F, -0.1F)));
  CHECK_FALSE(caster.is_occluded(from, Eigen::Vector3f(1.0F, 1.0F, 0.1F)));
  CHECK(std::isinf(caster.range_m({from, Eigen::Vector3f::UnitZ()})));
}

TEST_CASE("an empty mesh stops nothing") {
  const TriangleMesh mesh;
  const Caster caster(mesh);
  CHECK_FALSE(caster.cast({Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX()}));
}
