// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/layered_map.hpp"

#include <limits>

#include <doctest/doctest.h>

namespace warren {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Scan scan_at(double x_m) {
  Scan scan;
  scan.T_map_base.translation = {x_m, 0.0, 0.0};
  scan.points_sensor = {{2.0F, 0.0F, 0.0F}};
  return scan;
}

}  // namespace

TEST_CASE("the first scan opens a layer around its pose") {
  LayeredMap map(MappingConfig{});
  CHECK(map.snapshot() == nullptr);
  CHECK_FALSE(map.info().current.has_value());
  CHECK(map.integrate(scan_at(1000.0), 7, {}) == 1);
  const MapInfoReport info = map.info();
  REQUIRE(info.current.has_value());
  CHECK(info.current->frame_epoch == 7);
  CHECK(info.current->counts.occupied == 1);
  CHECK(std::abs(info.current->origin_map_m.x() - 1000.0) < 0.8);
  REQUIRE(info.current->known.has_value());
  CHECK(info.current->known->low_map_m.x() <= 1000.0);
  CHECK(info.current->known->high_map_m.x() >= 1002.0);
}

TEST_CASE("a new epoch opens a layer, the old one is over") {
  LayeredMap map(MappingConfig{});
  CHECK(map.integrate(scan_at(0.0), 5, {}).has_value());
  CHECK(map.integrate(scan_at(0.0), 3, {}).has_value());
  CHECK(map.layer_count() == 2);
  CHECK(map.current()->frame_epoch == 3);
  const auto late = map.integrate(scan_at(0.0), 5, {});
  REQUIRE_FALSE(late.has_value());
  CHECK(late.error() == "frame_epoch_over");
  CHECK(map.layer_count() == 2);
}

TEST_CASE("a scan with an unusable pose opens no layer and is counted") {
  LayeredMap map(MappingConfig{});
  Scan scan = scan_at(kNan);
  CHECK(map.integrate(scan, 1, {}).error() == "bad_pose");
  scan = scan_at(0.0);
  scan.T_base_sensor.rotation.coeffs().setZero();
  CHECK(map.integrate(scan, 1, {}).error() == "bad_pose");
  CHECK(map.integrate(scan_at(1e300), 1, {}).error() == "origin_outside_key_space");
  CHECK(map.layer_count() == 0);
  CHECK(map.integrate(scan_at(0.0), 1, {}).has_value());
  CHECK(map.integrate(scan_at(1e6), 1, {}).error() == "origin_outside_key_space");
  RejectionCounts counts = map.rejected();
  CHECK(count_of(counts, Rejection::kBadPose) == 2);
  CHECK(count_of(counts, Rejection::kOriginOutsideKeySpace) == 2);
}

TEST_CASE("gravity must be a direction") {
  LayeredMap map(MappingConfig{});
  for (const double z : {0.0, kNan, std::numeric_limits<double>::infinity()}) {
    Scan scan = scan_at(0.0);
    scan.gravity_map = {0.0, 0.0, z};
    CHECK(map.integrate(scan, 1, {}).error() == "bad_gravity");
  }
  Scan scan = scan_at(0.0);
  scan.gravity_map = {0.0, 0.0, -9.81};
  CHECK(map.integrate(scan, 1, {}).has_value());
}

TEST_CASE("points that cannot be used are counted and the others used") {
  LayeredMap map(MappingConfig{});
  Scan scan = scan_at(0.0);
  scan.points_sensor.push_back({std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F});
  scan.points_sensor.push_back({0.1F, 0.0F, 0.0F});
  SensorFilter filter;
  filter.min_range_m = 0.3;
  CHECK(map.integrate(scan, 1, filter) == 1);
  RejectionCounts counts = map.rejected();
  CHECK(count_of(counts, Rejection::kNoReturn) == 1);
  CHECK(count_of(counts, Rejection::kBelowMinRange) == 1);
}

TEST_CASE("a pose update moves the current epoch only") {
  LayeredMap map(MappingConfig{});
  PoseUpdateMessage update{1, {}};
  update.T_fleet_map.translation = {1.0, 2.0, 3.0};
  CHECK_FALSE(map.update_pose(update));
  CHECK(map.integrate(scan_at(0.0), 1, {}).has_value());
  CHECK(map.update_pose(update));
  CHECK(map.info().current->T_fleet_map.translation.y() == 2.0);
  update.frame_epoch = 2;
  CHECK_FALSE(map.update_pose(update));
  update = {1, {}};
  update.T_fleet_map.translation.x() = kNan;
  CHECK_FALSE(map.update_pose(update));
  CHECK(map.info().current->T_fleet_map.translation.x() == 1.0);
}

TEST_CASE("epochs without end do not take memory without end") {
  LayeredMap map(MappingConfig{});
  for (std::uint64_t epoch = 0; epoch < LayeredMap::kMaxLayers; ++epoch) {
    CHECK(map.integrate(scan_at(0.0), epoch, {}).has_value());
  }
  const auto refused = map.integrate(scan_at(0.0), LayeredMap::kMaxLayers, {});
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error() == "too_many_frame_epochs");
}

}  // namespace warren
