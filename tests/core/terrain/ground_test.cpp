// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/ground.hpp"

#include <map>
#include <set>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace warren;

namespace {

// A map written down voxel by voxel.
class DrawnMap : public TerrainView {
 public:
  void put(const VoxelKey& key, std::optional<float> cost) { voxels_[key] = cost; }
  void put_floor(std::int32_t z, std::optional<float> cost) {
    for (std::int32_t x = -20; x < 20; ++x) {
      for (std::int32_t y = -20; y < 20; ++y) put({x, y, z}, cost);
    }
  }
  void put_stair(const VoxelKey& key) {
    voxels_.try_emplace(key, std::nullopt);
    stairs_.insert(key);
  }

  const Lattice& lattice() const override { return lattice_; }
  VoxelState state(const VoxelKey& key) const override {
    REQUIRE(KeyBox{}.contains(key));
    return voxels_.contains(key) ? VoxelState::kOccupied : VoxelState::kUnknown;
  }
  std::optional<float> cost(const VoxelKey& key) const override {
    const auto found = voxels_.find(key);
    return found == voxels_.end() ? std::nullopt : found->second;
  }
  bool is_stair(const VoxelKey& key) const override { return stairs_.contains(key); }

 private:
  Lattice lattice_{0.1};
  std::map<VoxelKey, std::optional<float>> voxels_;
  std::set<VoxelKey> stairs_;
};

// Stands on the voxels of z = -1, whose upper side is at 0.
GroundQuery query_at(double x, double y, double z, double yaw_rad = 0.0) {
  GroundQuery query;
  query.T_layer_base.translation() = Eigen::Vector3d(x, y, z);
  query.T_layer_base.rotate(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  query.footprint = {0.8, 0.6};
  return query;
}

}  // namespace

TEST_CASE("flat ground of one cost is what the query says it is") {
  DrawnMap map;
  map.put_floor(-1, 0.05F);
  const GroundReport report = ground(map, query_at(0.0, 0.0, 0.0, 0.4));
  CHECK(report.columns == 16 * 12);
  CHECK(report.columns_with_ground == report.columns);
  CHECK(*report.mean_cost == doctest::Approx(0.05));
  CHECK(*report.max_cost == doctest::Approx(0.05));
  CHECK(report.unknown_share == 0.0);
  CHECK(report.stairs_share == 0.0);
  CHECK(report.step_m == 0.0);
  CHECK(validity(report, false) == Validity::kTraversable);
}

TEST_CASE("one voxel counts by its share of the footprint in the mean, and whole in the max") {
  DrawnMap map;
  map.put_floor(-1, 0.0F);
  map.put({1, 1, -1}, 0.5F);
  const GroundReport report = ground(map, query_at(0.0, 0.0, 0.0));
  CHECK(*report.mean_cost == doctest::Approx(0.5 * 4 / (16 * 12)));
  CHECK(*report.max_cost == doctest::Approx(0.5));
  CHECK(validity(report, false) == Validity::kTooHard);
  // Outside of the footprint it does not matter.
  CHECK(validity(map, query_at(-1.0, -1.0, 0.0), false) == Validity::kTraversable);
}

TEST_CASE("ground without a cost, and no ground, are unknown and never safe") {
  DrawnMap map;
  map.put_floor(-1, 0.0F);
  map.put({2, 0, -1}, std::nullopt);
  const GroundReport one_gap = ground(map, query_at(0.0, 0.0, 0.0));
  CHECK(one_gap.unknown_share == doctest::Approx(4.0 / (16 * 12)));
  CHECK(validity(one_gap, false) == Validity::kUnknown);
  CHECK_FALSE(is_valid(validity(one_gap, true)));

  ValidityRule lenient;
  lenient.unknown_up_to = 0.05;
  CHECK(validity(one_gap, false, lenient) == Validity::kTraversable);
  lenient.unknown_up_to = 1.0;  // even then unknown ground counts as impossible in the mean
  CHECK(validity(ground(DrawnMap{}, query_at(0, 0, 0)), false, lenient) == Validity::kUnknown);

  const GroundReport nothing = ground(DrawnMap{}, query_at(0.0, 0.0, 0.0));
  CHECK_FALSE(nothing.mean_cost);
  CHECK_FALSE(nothing.max_cost);
  CHECK(nothing.unknown_share == 1.0);
  CHECK(validity(nothing, true) == Validity::kUnknown);

  DrawnMap no_data;
  no_data.put_floor(-1, std::nullopt);
  CHECK(ground(no_data, query_at(0, 0, 0)).columns_with_ground == 16 * 12);
  CHECK(validity(no_data, query_at(0, 0, 0), false) == Validity::kUnknown);
}

TEST_CASE("the paper's thresholds are limits that a cost must stay below") {
  GroundReport report;
  report.unknown_share = 0.0;
  report.mean_cost = 0.0999;
  report.max_cost = 0.1999;
  CHECK(validity(report, false) == Validity::kTraversable);
  report.mean_cost = 0.10;
  CHECK(validity(report, false) == Validity::kTooHard);
  report.mean_cost = 0.05;
  report.max_cost = 0.20;
  CHECK(validity(report, false) == Validity::kTooHard);
}

TEST_CASE("enough stairs are valid for who can climb them, whatever the cost") {
  DrawnMap map;
  map.put_floor(-1, 0.9F);
  for (std::int32_t y = -20; y < 20; ++y) {
    for (std::int32_t x = 0; x < 3; ++x) map.put_stair({x, y, -1});
  }
  const GroundReport report = ground(map, query_at(0.0, 0.0, 0.0));
  CHECK(report.stairs_share == doctest::Approx(3.0 / 8.0));
  CHECK(validity(report, true) == Validity::kStairs);
  CHECK(validity(report, false) == Validity::kTooHard);
  CHECK(validity(map, query_at(-0.2, 0.0, 0.0), true) == Validity::kTooHard);  // 1 row of 8
}

TEST_CASE("a step is the height between neighbouring columns, a hole's depth is not known") {
  DrawnMap map;
  map.put_floor(-1, 0.0F);
  for (std::int32_t y = -20; y < 20; ++y) map.put({1, y, 1}, 0.0F);
  CHECK(ground(map, query_at(0.0, 0.0, 0.0)).step_m == doctest::Approx(0.2));
  map.put_floor(-30, 0.0F);  // out of reach
  CHECK(ground(map, query_at(0.0, 0.0, 0.0)).step_m == doctest::Approx(0.2));
}

TEST_CASE("ground is found from above, within reach, and what hangs lower is in the way") {
  DrawnMap map;
  map.put_floor(-1, 0.0F);
  map.put_floor(2, 0.7F);
  CHECK(*ground(map, query_at(0.0, 0.0, 0.0)).max_cost == doctest::Approx(0.7));
  GroundQuery crouching = query_at(0.0, 0.0, 0.0);
  crouching.above_m = 0.15;
  CHECK(*ground(map, crouching).max_cost == doctest::Approx(0.0));
  CHECK(ground(map, query_at(0.0, 0.0, 2.0)).columns_with_ground == 0);  // 1.7 m too high
}

TEST_CASE("columns run along gravity, not along the robot's own axis") {
  DrawnMap map;
  map.put_floor(-1, 0.0F);
  for (std::int32_t y = -20; y < 20; ++y) map.put({6, y, -1}, 1.0F);
  // Nose up by 30 degrees; along its own axis the front would look at x = 0.7.
  GroundQuery query = query_at(0.0, 0.0, 0.45);
  query.T_layer_base.rotate(Eigen::AngleAxisd(-0.5236, Eigen::Vector3d::UnitY()));
  query.below_m = 1.5;
  CHECK(*ground(map, query).max_cost == doctest::Approx(0.0));
  query.gravity = query.T_layer_base.rotation() * -Eigen::Vector3d::UnitZ();
  CHECK(*ground(map, query).max_cost == doctest::Approx(1.0));
}

TEST_CASE("below the key space there is no ground") {
  DrawnMap map;
  map.put_floor(kKeyMax, 0.0F);  // not where the keys begin again
  GroundQuery query = query_at(0.0, 0.0, kKeyMin * 0.1 + 0.25);
  query.below_m = 20.0;
  const GroundReport report = ground(map, query);
  CHECK(report.columns == 16 * 12);
  CHECK(report.columns_with_ground == 0);
}

TEST_CASE("whatever the numbers, a valid query ends and its shares add up") {
  DrawnMap map;
  map.put_floor(-1, 0.05F);
  CHECK(rc::check("any pose", [&] {
    const auto metres = [](int most_mm) { return 1e-3 * *rc::gen::inRange(-most_mm, most_mm + 1); };
    GroundQuery query = query_at(metres(3000), metres(3000), metres(1500), metres(3141));
    query.T_layer_base.rotate(Eigen::AngleAxisd(metres(1500), Eigen::Vector3d::UnitX()));
    query.footprint = {1e-3 * *rc::gen::inRange(1, 2000), 1e-3 * *rc::gen::inRange(1, 2000)};
    query.gravity =
        Eigen::AngleAxisd(metres(700), Eigen::Vector3d::UnitY()) * -Eigen::Vector3d::UnitZ();
    RC_ASSERT(query.is_valid(0.1));
    const GroundReport report = ground(map, query);
    RC_ASSERT(report.columns > 0);
    RC_ASSERT(report.columns_with_cost <= report.columns_with_ground);
    RC_ASSERT(report.columns_with_ground <= report.columns);
    RC_ASSERT(report.mean_cost.has_value() == (report.columns_with_cost > 0));
    if (report.mean_cost) RC_ASSERT(std::abs(*report.mean_cost - 0.05) < 1e-6);
  }));
}

TEST_CASE(
    "a query's columns are at most so many voxels long together, whatever makes them so many") {
  GroundQuery query = query_at(0.0, 0.0, 0.0);
  query.footprint = {3.2, 1.6};  // 64 by 32 columns
  query.above_m = 3.1;
  query.below_m = 3.2;
  CHECK(query.voxels(0.1) == doctest::Approx(GroundQuery::kVoxelsMax));
  query.below_m = 3.15;
  CHECK(query.is_valid(0.1));
  query.below_m = 3.25;
  CHECK_FALSE(query.is_valid(0.1));
  CHECK(query.makes_sense());
  query.above_m = query.below_m = 0.0;
  CHECK(query.is_valid(0.1));
  query.footprint = {50.0, 50.0};
  CHECK_FALSE(query.is_valid(0.1));
}

TEST_CASE("queries that make no sense are not valid") {
  const auto is_valid = [](auto change) {
    GroundQuery query = query_at(0.0, 0.0, 0.0);
    change(query);
    return query.is_valid(0.1);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  CHECK(is_valid([](GroundQuery&) {}));
  CHECK_FALSE(is_valid([](GroundQuery& q) { q.footprint.length_m = 0.0; }));
  CHECK_FALSE(is_valid([](GroundQuery& q) { q.footprint.width_m = kNan; }));
  CHECK_FALSE(is_valid([](GroundQuery& q) { q.footprint = {50.0, 50.0}; }));
  CHECK_FALSE(is_valid([](GroundQuery& q) { q.above_m = -1.0; }));
  CHECK_FALSE(is_valid([](GroundQuery& q) { q.below_m = 1e9; }));
  CHECK_FALSE(is_valid([](GroundQuery& q) { q.gravity *= 2.0; }));
  CHECK_FALSE(is_valid([](GroundQuery& q) { q.T_layer_base.translation().x() = kNan; }));
  CHECK_FALSE(is_valid([](GroundQuery& q) { q.T_layer_base.translation().x() = 1e300; }));
}
