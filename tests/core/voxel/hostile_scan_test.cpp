// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/voxel/self_map.hpp"

using namespace warren;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr Point3f kHome{0.05F, 0.05F, 0.05F};

IntegrationReport integrate(SelfMap& map, std::vector<Point3f> points,
                            std::optional<double> max_range_m = std::nullopt) {
  return map.integrate({kHome, points, max_range_m, {}});
}

}  // namespace

TEST_CASE("an empty scan changes nothing") {
  SelfMap map(SelfMapConfig{});
  CHECK(integrate(map, {}).blocks_changed == 0);
  CHECK(map.counts().blocks == 0);
}

TEST_CASE("points that are not finite are counted and mark nothing") {
  for (const std::optional<double> max_range_m : {std::optional<double>{}, {5.0}}) {
    for (const bool one_ray_per_end_voxel : {false, true}) {
      SelfMap map({0.1, SensorModel{}, one_ray_per_end_voxel});
      IntegrationReport report = integrate(
          map, {{kNaN, 0.0F, 0.0F}, {kInf, 0.0F, 0.0F}, {0.0F, -kInf, kInf}}, max_range_m);
      CHECK(count_of(report.rejected, Rejection::kNoReturn) == 1);
      CHECK(count_of(report.rejected, Rejection::kInfinite) == 2);
      CHECK(map.counts().free + map.counts().occupied == 0);
    }
  }
}

TEST_CASE("a point beyond the key space is counted, or carves up to max range") {
  SelfMap map(SelfMapConfig{});
  IntegrationReport report = integrate(map, {{1e6F, 0.0F, 0.0F}});
  CHECK(count_of(report.rejected, Rejection::kOutsideKeySpace) == 1);
  CHECK(map.counts().free == 0);
  report = integrate(map, {{1e6F, 0.05F, 0.05F}}, 5.0);
  CHECK(map.counts().free > 40);
  CHECK(map.counts().occupied == 0);
}

TEST_CASE("a sensor outside the key space is counted") {
  SelfMap map(SelfMapConfig{});
  const std::vector<Point3f> points = {{0.0F, 0.0F, 0.0F}};
  for (const float place : {1e6F, kNaN, kInf}) {
    IntegrationReport report = map.integrate({{place, 0.0F, 0.0F}, points, std::nullopt, {}});
    CHECK(count_of(report.rejected, Rejection::kOriginOutsideKeySpace) == 1);
  }
  CHECK(map.counts().free + map.counts().occupied == 0);
}

TEST_CASE("a million points in one voxel are one hit") {
  SelfMap map(SelfMapConfig{});
  const IntegrationReport report =
      integrate(map, std::vector<Point3f>(1000000, Point3f{3.05F, 0.05F, 0.05F}));
  CHECK(report.rays == 1000000);
  CHECK(report.voxels_hit == 1);
  CHECK(*map.log_odds({30, 0, 0}) == doctest::Approx(0.8473).epsilon(1e-3));
}

TEST_CASE("a point on the sensor marks its voxel and carves nothing") {
  SelfMap map(SelfMapConfig{});
  integrate(map, {kHome});
  CHECK(map.counts().occupied == 1);
  CHECK(map.counts().free == 0);
}

TEST_CASE("a direction too short to have a length does not hang") {
  SelfMap map(SelfMapConfig{});
  const std::vector<Point3f> points = {{-1e-30F, -1e-30F, -1e-30F}, {1e-30F, -1e-38F, 0.0F}};
  map.integrate({{0.0F, 0.0F, 0.0F}, points, std::nullopt, {}});
  map.integrate({{1e-30F, 1e-30F, 1e-30F}, points, 5.0, {}});
  CHECK(map.counts().occupied >= 1);
}

TEST_CASE("the corners of the key space can be mapped") {
  SelfMap map(SelfMapConfig{});
  const Point3f low{-3276.75F, -3276.75F, -3276.75F};
  const Point3f high{3276.7F, 3276.7F, 3276.7F};
  const std::vector<Point3f> from_low = {{-3270.0F, -3276.0F, -3276.7F}, low};
  const std::vector<Point3f> from_high = {{3276.7F, 3270.0F, 3276.7F}};
  map.integrate({low, from_low, std::nullopt, {}});
  map.integrate({high, from_high, std::nullopt, {}});
  CHECK(map.state(high) == VoxelState::kFree);
  CHECK(map.state(Point3f{-3270.0F, -3276.0F, -3276.7F}) == VoxelState::kOccupied);
}

TEST_CASE("no bit pattern breaks the integration, and no ray is lost uncounted") {
  CHECK(rc::check("any floats", [] {
    SelfMap map({*rc::gen::element(0.05, 0.2), SensorModel{}, *rc::gen::arbitrary<bool>()});
    const auto any_float =
        rc::gen::oneOf(rc::gen::map(rc::gen::arbitrary<std::uint32_t>(),
                                    [](std::uint32_t bits) { return std::bit_cast<float>(bits); }),
                       rc::gen::map(rc::gen::inRange(-3000, 3000),
                                    [](int i) { return static_cast<float>(i) * 0.01F; }));
    const auto any_point = rc::gen::build<Point3f>(rc::gen::set(&Point3f::x, any_float),
                                                   rc::gen::set(&Point3f::y, any_float),
                                                   rc::gen::set(&Point3f::z, any_float));
    const auto points = *rc::gen::container<std::vector<Point3f>>(any_point);
    const auto carved = *rc::gen::container<std::vector<Point3f>>(any_point);
    const IntegrationReport report = map.integrate({kHome, points, 20.0, carved});
    std::uint64_t counted = report.rays;
    for (const std::uint64_t rejected : report.rejected) counted += rejected;
    RC_ASSERT(counted <= points.size() + carved.size());
    if (!map.config().one_ray_per_end_voxel) RC_ASSERT(counted == points.size() + carved.size());
  }));
}
