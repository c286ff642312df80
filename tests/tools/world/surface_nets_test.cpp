// SPDX-License-Identifier: Apache-2.0
#include "tools/world/surface_nets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "tests/tools/world/mesh_measures.hpp"

namespace warren::world {
namespace {

// A ball of air in rock; `blind` makes may_cross() as wrong as can be.
class BallOfAir : public SurfaceField {
 public:
  BallOfAir(const Eigen::Vector3d& centre, double radius_m, bool blind = false)
      : centre_(centre), radius_m_(radius_m), blind_(blind) {}
  double value(const Eigen::Vector3d& position) const override {
    return (position - centre_).norm() - radius_m_;
  }
  bool may_cross(const Eigen::Vector3d& centre, double radius_m) const override {
    if (blind_ && centre.x() > centre_.x()) return false;
    return std::abs(value(centre)) <= radius_m;
  }

 private:
  Eigen::Vector3d centre_;
  double radius_m_;
  bool blind_;
};

const Eigen::Vector3d kCentre(0.3, -5.2, 2.7);
const std::vector<Eigen::AlignedBox3d> kBoxes = {
    {Eigen::Vector3d(kCentre.array() - 3.0), Eigen::Vector3d(kCentre.array() + 3.0)}};

}  // namespace

TEST_CASE("a ball of air becomes a closed surface, near to the ball, that faces the air") {
  const BallOfAir field(kCentre, 2.0);
  const TriangleMesh mesh = surface_nets(field, kBoxes, 0.2);
  CHECK(test::is_closed(mesh));
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    CHECK(std::abs(field.value(vertex.cast<double>())) < 0.02);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3d outward = mesh.vertices[mesh.triangles[i][0]].cast<double>() - kCentre;
    CHECK(test::normal_of(mesh, i).dot(outward) < 0.0);
  }
  // Inside out: seen from the rock it is a negative volume.
  CHECK(-test::volume_m3(mesh) ==
        doctest::Approx(4.0 / 3.0 * std::numbers::pi * 8.0).epsilon(0.02));
}

TEST_CASE("finer cells come nearer to the surface") {
  const BallOfAir field(kCentre, 2.0);
  const auto worst_m = [&](double cell_m) {
    double worst = 0.0;
    for (const Eigen::Vector3f& vertex : surface_nets(field, kBoxes, cell_m).vertices)
      worst = std::max(worst, std::abs(field.value(vertex.cast<double>())));
    return worst;
  };
  CHECK(worst_m(0.1) < 0.5 * worst_m(0.2));
}

TEST_CASE("the surface is followed where the boxes or may_cross() miss it") {
  const TriangleMesh whole = surface_nets(BallOfAir(kCentre, 2.0), kBoxes, 0.2);
  const TriangleMesh followed = surface_nets(BallOfAir(kCentre, 2.0, true), kBoxes, 0.2);
  CHECK(test::is_closed(followed));
  CHECK(followed.triangles.size() == whole.triangles.size());
  const std::vector<Eigen::AlignedBox3d> corner = {
      {Eigen::Vector3d(kCentre), Eigen::Vector3d(kCentre.array() + 3.0)}};
  const TriangleMesh from_corner = surface_nets(BallOfAir(kCentre, 2.0), corner, 0.2);
  CHECK(from_corner.triangles.size() == whole.triangles.size());
}

TEST_CASE("where there is no surface there is no mesh") {
  const std::vector<Eigen::AlignedBox3d> far = {
      {Eigen::Vector3d(50, 50, 50), Eigen::Vector3d(60, 60, 60)}};
  CHECK(surface_nets(BallOfAir(kCentre, 2.0), far, 0.2).triangles.empty());
}

}  // namespace warren::world
