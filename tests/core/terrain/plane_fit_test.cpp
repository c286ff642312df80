// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/plane_fit.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/core/terrain/clouds.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;

namespace {

// Moments of one neighbourhood of the given offsets.
Neighbourhoods of_offsets(const std::vector<Eigen::Vector3d>& offsets) {
  Neighbourhoods n;
  std::array<double, 9> sums{};
  for (const auto& o : offsets) {
    const std::array<double, 9> terms = {o.x(),         o.y(),         o.z(),
                                         o.x() * o.x(), o.x() * o.y(), o.x() * o.z(),
                                         o.y() * o.y(), o.y() * o.z(), o.z() * o.z()};
    for (std::size_t i = 0; i < 9; ++i) sums[i] += terms[i];
  }
  for (std::size_t i = 0; i < 9; ++i) {
    n.moments[i].assign(1 + kVectorPadding, static_cast<float>(sums[i]));
  }
  n.states.assign(1, NeighbourhoodState::kFound);
  return n;
}

Eigen::Matrix3d covariance_of(const Neighbourhoods& n, double k) {
  std::array<double, 9> m{};
  for (std::size_t i = 0; i < 9; ++i) m[i] = static_cast<double>(n.moments[i][0]) / k;
  Eigen::Matrix3d c;
  c << m[3] - m[0] * m[0], m[4] - m[0] * m[1], m[5] - m[0] * m[2],  //
      m[4] - m[0] * m[1], m[6] - m[1] * m[1], m[7] - m[1] * m[2],   //
      m[5] - m[0] * m[2], m[7] - m[1] * m[2], m[8] - m[2] * m[2];
  return c;
}

PlaneFits fit(const Neighbourhoods& n, std::uint32_t k) {
  PlaneFits fits;
  fit_planes(n, k, fits);
  return fits;
}

}  // namespace

TEST_CASE("eigenvalues and normal are those of Eigen's iterative solver") {
  CHECK(rc::check("as Eigen", [] {
    std::vector<Eigen::Vector3d> offsets;
    const auto flatness = *rc::gen::element(1.0, 0.1, 1e-3, 0.0);
    const Eigen::Quaterniond turned =
        Eigen::Quaterniond(*rc::gen::inRange(1, 100), *rc::gen::inRange(-100, 100),
                           *rc::gen::inRange(-100, 100), *rc::gen::inRange(-100, 100))
            .normalized();
    for (int i = 0; i < 24; ++i) {
      const auto metres = [] { return 1e-4 * *rc::gen::inRange(-2000, 2000); };
      offsets.push_back(turned * Eigen::Vector3d(metres(), metres(), flatness * metres()));
    }
    const Neighbourhoods n = of_offsets(offsets);
    const PlaneFits fits = fit(n, 24);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance_of(n, 24.0));
    const Eigen::Vector3d l = solver.eigenvalues().cwiseMax(0.0);
    // Offsets of 0.2 m, squared: below this there is nothing but rounding.
    constexpr double kRounding = 1e-15;
    const double tolerance = 1e-6 * l[2] + kRounding;
    RC_ASSERT(std::abs(fits.l0[0] - l[0]) < tolerance);
    RC_ASSERT(std::abs(fits.l1[0] - l[1]) < tolerance);
    RC_ASSERT(std::abs(fits.l2[0] - l[2]) < tolerance);
    // One place, to the precision of the sums (float): no axes.
    constexpr double kSumsRounding = 1e-7;
    if (l[2] < kSumsRounding) return;
    RC_ASSERT(std::abs(fits.curvature[0] - l[0] / l.sum()) < 1e-6);
    if (l[1] - l[0] < 1e-4 * l[2]) return;
    const Eigen::Vector3d normal(fits.normal_x[0], fits.normal_y[0], fits.normal_z[0]);
    RC_ASSERT(normal.cross(solver.eigenvectors().col(0)).norm() < 1e-4);
    RC_ASSERT(std::abs(normal.norm() - 1.0) < 1e-6);
  }));
}

TEST_CASE("points in one place give a unit normal and no curvature, not a NaN") {
  const PlaneFits fits = fit(of_offsets(std::vector<Eigen::Vector3d>(24, {0.0, 0.0, 0.0})), 24);
  CHECK(fits.curvature[0] == 0.0F);
  CHECK(fits.normal_z[0] == 1.0F);
  CHECK(fits.l2[0] == 0.0F);
}

TEST_CASE("points on a line have one eigenvalue") {
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 24; ++i) line.emplace_back(0.03 * i, -0.01 * i, 0.02 * i);
  const PlaneFits fits = fit(of_offsets(line), 24);
  CHECK(fits.l2[0] > 0.05F);
  CHECK(fits.l1[0] < 1e-6F * fits.l2[0]);
}

TEST_CASE("every instruction set fits the same bits") {
  const auto scan = test::scan_room({}, {32, 256}, {0.1F, 0.2F, 0.3F}, 3);
  CloudReducer reducer(0.05F);
  NeighbourSearch search({});
  const Neighbourhoods& n = search.find(reducer.reduce(scan.points_layer));
  const PlaneFits wanted = fit(n, 24);
  test::on_every_target([&] {
    const PlaneFits fits = fit(n, 24);
    for (std::size_t i = 0; i < n.states.size(); ++i) {
      REQUIRE(fits.normal_x[i] == wanted.normal_x[i]);
      REQUIRE(fits.normal_y[i] == wanted.normal_y[i]);
      REQUIRE(fits.normal_z[i] == wanted.normal_z[i]);
      REQUIRE(fits.curvature[i] == wanted.curvature[i]);
      REQUIRE(fits.l1[i] == wanted.l1[i]);
    }
  });
}
