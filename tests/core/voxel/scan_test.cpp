// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/scan.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace warren;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr double kResolution = 0.1;

Scan scan_of(std::vector<Point3f> points) {
  Scan scan;
  scan.points_sensor = std::move(points);
  return scan;
}

struct Prepared {
  std::optional<LayerScan> scan;
  RejectionCounts rejected{};
  std::uint64_t count(Rejection reason) { return count_of(rejected, reason); }
};

Prepared prepare(ScanPreparer& preparer, const Scan& scan, const SensorFilter& filter = {},
                 const LayerOrigin& origin = {}) {
  Prepared prepared;
  prepared.scan = preparer.prepare(scan, filter, origin, kResolution, prepared.rejected);
  return prepared;
}

}  // namespace

TEST_CASE("points move from the sensor to the layer") {
  Scan scan = scan_of({{1.0F, 0.0F, 0.0F}});
  scan.T_map_base.translation = {10.0, 20.0, 30.0};
  scan.T_map_base.rotation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  scan.T_base_sensor.translation = {0.0, 0.0, 0.5};
  ScanPreparer preparer;
  const Prepared prepared = prepare(preparer, scan, {}, {80, 160, 240});
  REQUIRE(prepared.scan);
  const Point3f& origin = prepared.scan->origin_layer;
  CHECK(origin.x == doctest::Approx(2.0F));
  CHECK(origin.z == doctest::Approx(6.5F));
  const Point3f& point = prepared.scan->points_layer[0];
  CHECK(point.x == doctest::Approx(2.0F));
  CHECK(point.y == doctest::Approx(5.0F));
}

TEST_CASE("every unusable point is counted by its reason") {
  ScanPreparer preparer;
  SensorFilter filter;
  filter.min_range_m = 0.5;
  filter.body_box = BodyBox{{-1.0, -1.0, -1.0}, {0.0, 1.0, 1.0}};
  Prepared prepared = prepare(preparer,
                              scan_of({{kNaN, 0.0F, 0.0F},
                                       {0.0F, kNaN, kInf},
                                       {kInf, 0.0F, 0.0F},
                                       {0.0F, 0.0F, 0.0F},
                                       {0.3F, 0.0F, 0.0F},
                                       {-0.9F, 0.2F, 0.0F},
                                       {5.0F, 0.0F, 0.0F}}),
                              filter);
  REQUIRE(prepared.scan);
  CHECK(prepared.scan->points_layer.size() == 1);
  CHECK(prepared.count(Rejection::kNoReturn) == 2);
  CHECK(prepared.count(Rejection::kInfinite) == 1);
  CHECK(prepared.count(Rejection::kZeroRange) == 1);
  CHECK(prepared.count(Rejection::kBelowMinRange) == 1);
  CHECK(prepared.count(Rejection::kInBodyBox) == 1);
}

TEST_CASE("a pose that is no rigid pose rejects the scan") {
  ScanPreparer preparer;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Scan scan = scan_of({{1.0F, 0.0F, 0.0F}});
    scan.T_map_base.translation.y() = bad;
    Prepared prepared = prepare(preparer, scan);
    CHECK_FALSE(prepared.scan);
    CHECK(prepared.count(Rejection::kBadPose) == 1);
    scan = scan_of({{1.0F, 0.0F, 0.0F}});
    scan.T_base_sensor.rotation.w() = bad;
    CHECK_FALSE(prepare(preparer, scan).scan);
  }
  Scan scan = scan_of({{1.0F, 0.0F, 0.0F}});
  scan.T_map_base.rotation = Eigen::Quaterniond(1.5, 0.0, 0.0, 0.0);
  CHECK_FALSE(prepare(preparer, scan).scan);
  scan.T_map_base.rotation = Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0);
  CHECK_FALSE(prepare(preparer, scan).scan);
}

TEST_CASE("a quaternion that is nearly of unit length is normalised") {
  Scan scan = scan_of({{1.0F, 0.0F, 0.0F}});
  scan.T_map_base.rotation = Eigen::Quaterniond(1.005, 0.0, 0.0, 0.0);
  ScanPreparer preparer;
  const Prepared prepared = prepare(preparer, scan);
  REQUIRE(prepared.scan);
  CHECK(prepared.scan->points_layer[0].x == doctest::Approx(1.0F));
}

TEST_CASE("a robot a million metres away maps as well as one at home") {
  Scan scan = scan_of({{1.234F, 0.0F, 0.0F}});
  const Eigen::Vector3d far_away(1e6 + 0.05, -1e6 - 0.05, 1e6);
  scan.T_map_base.translation = far_away;
  const auto origin = LayerOrigin::snapped(far_away, kResolution);
  REQUIRE(origin);
  CHECK(origin->x % kBlockEdge == 0);
  CHECK(origin->position_map(kResolution).x() <= far_away.x());
  CHECK(origin->position_map(kResolution).x() > far_away.x() - 0.9);
  ScanPreparer preparer;
  const Prepared prepared = prepare(preparer, scan, {}, *origin);
  REQUIRE(prepared.scan);
  const float dx = prepared.scan->points_layer[0].x - prepared.scan->origin_layer.x;
  CHECK(dx == doctest::Approx(1.234F).epsilon(1e-5));
}

TEST_CASE("a sensor outside the layer's key space rejects the scan") {
  Scan scan = scan_of({{1.0F, 0.0F, 0.0F}});
  scan.T_map_base.translation = {4000.0, 0.0, 0.0};
  ScanPreparer preparer;
  Prepared prepared = prepare(preparer, scan);
  CHECK_FALSE(prepared.scan);
  CHECK(prepared.count(Rejection::kOriginOutsideKeySpace) == 1);
}

TEST_CASE("no origin is snapped to for a position that no number can hold") {
  CHECK_FALSE(LayerOrigin::snapped({std::nan(""), 0.0, 0.0}, kResolution));
  CHECK_FALSE(LayerOrigin::snapped({1e300, 0.0, 0.0}, kResolution));
  CHECK(*LayerOrigin::snapped({-0.01, 0.0, 0.79}, kResolution) == LayerOrigin{-8, 0, 0});
}

TEST_CASE("no-return rays carve to max range only if told to") {
  Scan scan = scan_of({});
  scan.no_return_directions_sensor = {{0.0F, 3.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, {kNaN, 0.0F, 0.0F}};
  ScanPreparer preparer;
  CHECK(prepare(preparer, scan).scan->carved_ends_layer.empty());
  SensorFilter filter;
  filter.max_range_m = 10.0;
  filter.carve_no_returns = true;
  Prepared prepared = prepare(preparer, scan, filter);
  REQUIRE(prepared.scan->carved_ends_layer.size() == 1);
  CHECK(prepared.scan->carved_ends_layer[0].y > 10.0F);
  CHECK(prepared.count(Rejection::kBadDirection) == 2);
}

TEST_CASE("every reason has a name of its own") {
  for (std::size_t i = 0; i < kRejectionCount; ++i) {
    const std::string name = name_of(static_cast<Rejection>(i));
    CHECK(name != "unknown");
    for (std::size_t j = 0; j < i; ++j) CHECK(name != name_of(static_cast<Rejection>(j)));
  }
}
