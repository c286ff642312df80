// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/terrain_cost.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "core/terrain/terrain_judge.hpp"

using namespace warren;

namespace {

GroundShape slope(float degrees) {
  return {.normal_along_gravity = std::cos(degrees * std::numbers::pi_v<float> / 180.0F)};
}

}  // namespace

TEST_CASE("slopes cost what the field code's formula says") {
  const TerrainCostConfig paper = TerrainConfig::paper().cost;
  CHECK(terrain_cost(slope(0.0F), paper) == 0.0F);
  CHECK(terrain_cost(slope(20.0F), paper) == doctest::Approx(0.009).epsilon(0.05));
  CHECK(terrain_cost(slope(30.0F), paper) == doctest::Approx(0.096).epsilon(0.01));
  CHECK(terrain_cost(slope(34.0F), paper) == doctest::Approx(0.20).epsilon(0.01));
  CHECK(terrain_cost(slope(40.0F), paper) == doctest::Approx(0.51).epsilon(0.01));
  CHECK(terrain_cost(slope(45.0F), paper) == doctest::Approx(1.0).epsilon(0.01));
  CHECK(terrain_cost(slope(90.0F), paper) == 1.0F);
}

TEST_CASE("cost grows with slope and is the same for either sign of the normal") {
  for (const TerrainConfig& config : {TerrainConfig::paper(), TerrainConfig::robust()}) {
    float last = 0.0F;
    for (int quarter = 0; quarter <= 360; ++quarter) {
      const float degrees = 0.25F * static_cast<float>(quarter);
      GroundShape shape = slope(degrees);
      const float cost = terrain_cost(shape, config.cost);
      CHECK(cost >= last);
      shape.normal_along_gravity = -shape.normal_along_gravity;
      CHECK(terrain_cost(shape, config.cost) == cost);
      last = cost;
    }
    CHECK(last == 1.0F);
  }
}

TEST_CASE("curvature is weighed by its gain and the saturation") {
  TerrainCostConfig config = TerrainConfig::paper().cost;
  CHECK(terrain_cost({.curvature = 0.05F}, config) == doctest::Approx(0.2));
  config.saturation = 1.0F;
  CHECK(terrain_cost({.curvature = 0.05F}, config) == doctest::Approx(0.1));
}

TEST_CASE("roughness counts beyond the harmless, up to the critical, and only if asked for") {
  const TerrainCostConfig robust = TerrainConfig::robust().cost;
  CHECK(terrain_cost({.roughness_m = 0.20F}, TerrainConfig::paper().cost) == 0.0F);
  CHECK(terrain_cost({.roughness_m = 0.06F}, robust) == 0.0F);
  CHECK(terrain_cost({.roughness_m = 0.13F}, robust) == doctest::Approx(0.5));
  CHECK(terrain_cost({.roughness_m = 1.0F}, robust) == 1.0F);
  CHECK(terrain_cost({.roughness_m = 0.13F, .step_m = 0.125F}, robust) == doctest::Approx(1.0));
}

TEST_CASE("steps count beyond the harmless, up to the critical, and only if asked for") {
  const TerrainCostConfig robust = TerrainConfig::robust().cost;
  CHECK(terrain_cost({.step_m = 0.20F}, TerrainConfig::paper().cost) == 0.0F);
  CHECK(terrain_cost({.step_m = 0.05F}, robust) == 0.0F);
  CHECK(terrain_cost({.step_m = 0.125F}, robust) == doctest::Approx(0.5));
  CHECK(terrain_cost({.step_m = 0.20F}, robust) == doctest::Approx(1.0));
  CHECK(terrain_cost({.step_m = 1.0F}, robust) == 1.0F);
}
