// SPDX-License-Identifier: Apache-2.0
#include "core/registration/layer_registration.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "core/voxel/morton.hpp"

namespace warren {
namespace {

// Walls and floor of an L-shaped hall with pillars of different sizes, dense points in the fleet
// frame, as far as they lie between these x.
std::vector<Eigen::Vector3d> hall(double from_x, double to_x) {
  std::vector<Eigen::Vector3d> points;
  constexpr double kStep = 0.05;
  const auto add = [&](double x, double y, double z) {
    if (x >= from_x && x <= to_x) points.emplace_back(x, y, z);
  };
  const auto wall = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double length = (b - a).norm();
    for (double s = 0.0; s <= length; s += kStep) {
      const Eigen::Vector2d at = a + (b - a) * (s / length);
      for (double z = 0.0; z <= 2.5; z += kStep) add(at.x(), at.y(), z);
    }
  };
  const std::vector<Eigen::Vector2d> outline{{0.0, 0.0}, {18.0, 0.0}, {18.0, 6.0},
                                             {9.0, 6.0}, {9.0, 12.0}, {0.0, 12.0}};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    wall(outline[i], outline[(i + 1) % outline.size()]);
  }
  const std::vector<Eigen::Vector2d> pillars{{4.0, 3.0}, {6.5, 8.0}, {12.0, 2.0}, {15.0, 4.2}};
  for (const Eigen::Vector2d& pillar : pillars) {
    wall(pillar, pillar + Eigen::Vector2d(0.8, 0.2));
    wall(pillar, pillar + Eigen::Vector2d(-0.1, 0.6));
  }
  for (double x = 0.0; x <= 18.0; x += kStep) {
    for (double y = 0.0; y <= (x < 9.0 ? 12.0 : 6.0); y += kStep) add(x, y, 0.0);
  }
  return points;
}

// What a robot whose layer truly lies there makes of them.
Replica layer_of(const std::vector<Eigen::Vector3d>& points, std::uint32_t origin,
                 const Eigen::Isometry3d& T_fleet_layer, const Pose& said) {
  std::map<BlockOrdinal, BlockCodes> blocks;
  const Lattice lattice(0.1);
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = T_fleet_layer.inverse() * point;
    const std::uint64_t morton = morton_of(*lattice.key_of(p.x(), p.y(), p.z()));
    blocks[morton >> 9].set(static_cast<std::uint32_t>(morton & 511),
                            VoxelCode::occupied(1, false));
  }
  std::vector<CodedBlock> coded;
  for (const auto& [block, codes] : blocks) coded.push_back({block, CodeBlock(codes)});
  Replica layer(LayerId{origin, 0, origin}, kDefaultResolution);
  layer.publish(coded);
  layer.pose().update_origin({1, origin, said});
  return layer;
}

Eigen::Isometry3d level(double x, double y, double z, double yaw_deg) {
  Eigen::Isometry3d pose(Eigen::Translation3d(x, y, z));
  pose.rotate(Eigen::AngleAxisd(yaw_deg * std::numbers::pi / 180.0, Eigen::Vector3d::UnitZ()));
  return pose;
}

}  // namespace

TEST_CASE("a layer that lies a metre and eight degrees off is put where it belongs") {
  const Replica fixed = layer_of(hall(-1.0, 13.0), 1, Eigen::Isometry3d::Identity(), Pose{});
  const Eigen::Isometry3d T_true = level(7.0, 3.0, 0.3, 25.0);
  const Pose said = Pose::of(level(7.8, 2.4, 0.5, 33.0));
  const Replica moved = layer_of(hall(4.0, 19.0), 2, T_true, said);
  const auto result = register_layers(moved, fixed);
  REQUIRE(result.has_value());
  CHECK(result->shift_m.x() == doctest::Approx(-0.8).epsilon(0.1));
  CHECK(result->shift_m.y() == doctest::Approx(0.6).epsilon(0.1));
  CHECK(std::abs(result->shift_m.z() + 0.2) < 0.1);
  CHECK(std::abs(result->yaw_rad + 8.0 * std::numbers::pi / 180.0) < 0.01);
  CHECK(result->fit > 0.9);
  CHECK(result->fit > result->fit_before);
  CHECK(result->is_trusted());
}

TEST_CASE("an earlier correction is part of what is proposed in its place") {
  const Replica fixed = layer_of(hall(-1.0, 13.0), 1, Eigen::Isometry3d::Identity(), Pose{});
  const Eigen::Isometry3d T_true = level(7.0, 3.0, 0.0, 0.0);
  Replica moved = layer_of(hall(4.0, 19.0), 2, T_true, Pose::of(level(57.0, 3.0, 0.0, 0.0)));
  REQUIRE_FALSE(register_layers(moved, fixed).has_value());
  moved.pose().update_correction({1, 9, Pose::of(level(-49.5, 0.2, 0.0, 0.0))});
  const auto result = register_layers(moved, fixed);
  REQUIRE(result.has_value());
  CHECK((result->shift_m - Eigen::Vector3d(-50.0, 0.0, 0.0)).norm() < 0.1);
  CHECK(std::abs(result->yaw_rad) < 0.01);
}

TEST_CASE("layers that show different places are not trusted to fit") {
  const Replica fixed = layer_of(hall(-1.0, 13.0), 1, Eigen::Isometry3d::Identity(), Pose{});
  std::vector<Eigen::Vector3d> elsewhere;
  for (double x = 0.0; x < 10.0; x += 0.05) {
    for (double y = 0.0; y < 10.0; y += 0.05) {
      elsewhere.emplace_back(x, y, 1.0 + 0.8 * std::sin(2.1 * x) * std::cos(1.7 * y));
    }
  }
  const Replica other = layer_of(elsewhere, 2, Eigen::Isometry3d::Identity(), Pose{});
  const auto result = register_layers(other, fixed);
  REQUIRE(result.has_value());
  CHECK_FALSE(result->is_trusted());
}

}  // namespace warren
