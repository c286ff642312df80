// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/voxel_labels.hpp"

#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"
#include "tools/world/truth/triangle_box.hpp"

using namespace warren::world;

namespace {

std::vector<Eigen::Isometry3d> viewpoint(const Eigen::Vector3d& position) {
  return {Eigen::Isometry3d(Eigen::Translation3d(position))};
}

// A room of 4 x 3 x 2 m between the lattice's planes, with a screen across most of it at x = 0.55.
TriangleMesh room_with_screen() {
  TriangleMesh mesh = test::room({1.95F, 1.45F, 0.95F});
  mesh.add_quad({Eigen::Vector3f(0.55F, -1.45F, -0.95F), Eigen::Vector3f(0.55F, 0.65F, -0.95F),
                 Eigen::Vector3f(0.55F, 0.65F, 0.95F), Eigen::Vector3f(0.55F, -1.45F, 0.95F)},
                Surface::kWall);
  return mesh;
}

double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                           const Eigen::Vector3d& b) {
  const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - (a + share * (b - a))).norm();
}

}  // namespace

TEST_CASE("a triangle touches a box as a dense sampling of it does") {
  const TriangleMesh mesh = test::soup(300, 12);
  Random random(9);
  int touching = 0;
  int apart = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const std::array<Eigen::Vector3d, 3> corners{mesh.vertices[triangle[0]].cast<double>(),
                                                 mesh.vertices[triangle[1]].cast<double>(),
                                                 mesh.vertices[triangle[2]].cast<double>()};
    const Eigen::Vector3d shift(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6),
                                random.uniform(-0.6, 0.6));
    const Eigen::Vector3d centre = corners[0] + shift;
    double nearest = 1e9;  // of the samples to the centre, by the largest coordinate
    constexpr int kParts = 200;
    for (int i = 0; i <= kParts; ++i)
      for (int j = 0; i + j <= kParts; ++j) {
        const Eigen::Vector3d p = corners[0] + (corners[1] - corners[0]) * i / kParts +
                                  (corners[2] - corners[0]) * j / kParts;
        nearest = std::min(nearest, (p - centre).cwiseAbs().maxCoeff());
      }
    const double slack = 0.01;  // between samples
    if (nearest < 0.3) {
      ++touching;
      CHECK(triangle_touches_box(corners, centre, 0.3));
    } else if (nearest > 0.3 + slack) {
      ++apart;
      CHECK_FALSE(triangle_touches_box(corners, centre, 0.3));
    }
  }
  CHECK(touching > 50);
  CHECK(apart > 50);
}

TEST_CASE("in a room every voxel is surface at the walls, free within, and unseen outside") {
  const TriangleMesh mesh = test::room({1.95F, 1.45F, 0.95F});
  const Caster caster(mesh);
  const auto viewpoints = viewpoint({0.0, 0.0, 0.0});
  VoxelLabels labels(mesh, 0.1);
  labels.add_free(Sight(caster, viewpoints, {}), viewpoints);
  // 40 x 30 x 20 voxels, the outer layer being wall.
  CHECK(labels.count(VoxelTruth::kFree) == 38 * 28 * 18);
  CHECK(labels.count(VoxelTruth::kSurface) == 40 * 30 * 20 - 38 * 28 * 18);
  CHECK(labels.at({-20, 0, 0}) == VoxelTruth::kSurface);
  CHECK(labels.at({-19, 0, 0}) == VoxelTruth::kFree);
  CHECK(labels.at({-21, 0, 0}) == VoxelTruth::kUnseen);
}

TEST_CASE("behind a screen nothing is free until somebody looks there") {
  const TriangleMesh mesh = room_with_screen();
  const Caster caster(mesh);
  const auto left = viewpoint({-1.5, -1.0, 0.0});
  VoxelLabels labels(mesh, 0.1);
  labels.add_free(Sight(caster, left, {}), left);
  const VoxelLabels::Index behind = labels.index_of({1.5, -1.0, 0.0});
  CHECK(labels.at(behind) == VoxelTruth::kUnseen);
  // Every free voxel is in sight of the viewpoint past the screen's edge, and every voxel that is,
  // is free or has a surface.
  for (int x = -19; x < 19; ++x)
    for (int y = -14; y < 14; ++y) {
      const Eigen::Vector3d centre = labels.centre_of({x, y, 0});
      const Eigen::Vector3d from = left[0].translation();
      const double share = (0.55 - from.x()) / (centre.x() - from.x());
      const double y_at_screen = from.y() + share * (centre.y() - from.y());
      const bool is_hidden = centre.x() > 0.55 && y_at_screen < 0.65;
      if (labels.at({x, y, 0}) == VoxelTruth::kSurface) continue;
      CHECK((labels.at({x, y, 0}) == VoxelTruth::kFree) == !is_hidden);
    }
  const auto right = viewpoint({1.5, -1.0, 0.0});
  labels.add_free(Sight(caster, right, {}), right);
  CHECK(labels.at(behind) == VoxelTruth::kFree);
}

TEST_CASE("nothing is seen beyond the range or outside the beams") {
  const TriangleMesh mesh = test::room({1.95F, 1.45F, 0.95F});
  const Caster caster(mesh);
  const auto viewpoints = viewpoint({0.05, 0.05, 0.05});
  VoxelLabels near(mesh, 0.1);
  near.add_free(Sight(caster, viewpoints, {.max_range_m = 0.72}), viewpoints);
  VoxelLabels flat(mesh, 0.1);
  flat.add_free(Sight(caster, viewpoints, {.lowest_rad = -0.2, .highest_rad = 0.2}), viewpoints);
  for (int x = -19; x < 19; ++x)
    for (int z = -9; z < 9; ++z) {
      const Eigen::Vector3d way = near.centre_of({x, 0, z}) - Eigen::Vector3d(0.05, 0.05, 0.05);
      CHECK((near.at({x, 0, z}) == VoxelTruth::kFree) == (way.norm() < 0.72));
      const double elevation = std::atan2(way.z(), std::abs(way.x()));
      const bool is_in_beams = std::abs(elevation) < 0.2 || way.norm() < 1e-6;
      CHECK((flat.at({x, 0, z}) == VoxelTruth::kFree) == is_in_beams);
    }
}

TEST_CASE("a thin cable is surface in exactly the voxels that it passes") {
  TriangleMesh mesh;
  const Eigen::Vector3d a(0.03, 0.04, 0.06);
  const Eigen::Vector3d b(2.11, 1.37, 0.83);
  mesh.add_triangle(a.cast<float>(), b.cast<float>(),
                    (b + Eigen::Vector3d(0, 0, 1e-4)).cast<float>(), Surface::kCable);
  const VoxelLabels labels(mesh, 0.1);
  std::size_t passed = 0;
  VoxelLabels::Index last(99, 99, 99);
  for (int i = 0; i <= 100000; ++i) {
    const VoxelLabels::Index index = labels.index_of(a + (b - a) * i / 100000.0);
    if (index == last) continue;
    ++passed;
    last = index;
    CHECK(labels.at(index) == VoxelTruth::kSurface);
    CHECK(distance_to_segment(labels.centre_of(index), a, b) < 0.0867);
  }
  CHECK(labels.count(VoxelTruth::kSurface) >= passed);
  CHECK(labels.count(VoxelTruth::kSurface) <= passed + 2);
}
