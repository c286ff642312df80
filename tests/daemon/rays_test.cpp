// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "daemon/fleet/rays_answer.hpp"
#include "tests/daemon/small_fleet.hpp"

namespace warren {

using namespace test;

namespace {

// Places are metres from the corner of block (0, 0, 0) of the layer.
RaysQuestion rays_from(const Eigen::Vector3d& origin, const std::vector<Eigen::Vector3d>& to,
                       MapSource source = MapSource::kMerge) {
  RaysQuestion question;
  question.source = source;
  question.max_range_m = 3.0;
  for (const Eigen::Vector3d& direction : to) {
    question.rays.push_back({kFarOrigin.position_map(0.1) + origin, direction.normalized()});
  }
  return question;
}

RayEnd only_end(FleetMap& fleet, const RaysQuestion& question) {
  const auto answer = fleet.rays(question);
  REQUIRE(answer.has_value());
  REQUIRE(answer->ends.size() == 1);
  return answer->ends.front();
}

}  // namespace

TEST_CASE("a ray ends at the first voxel that is occupied, or unknown unless it goes through") {
  FleetMap fleet = fleet_map({false, false});
  tick(fleet, {floor_block({0, 0, 0}, 3)});
  for (const MapSource source : {MapSource::kSelf, MapSource::kMerge}) {
    const RayEnd floor = only_end(fleet, rays_from({0.35, 0.35, 0.55}, {{0, 0, -1}}, source));
    CHECK(floor.code == VoxelCode::occupied(3, false));
    CHECK(floor.voxel == VoxelKey{3, 3, 0});
    CHECK(floor.range_m == doctest::Approx(0.45));

    RaysQuestion up = rays_from({0.35, 0.35, 0.55}, {{0, 0, 1}}, source);
    const RayEnd unknown = only_end(fleet, up);
    CHECK(unknown.code == VoxelCode{});
    CHECK(unknown.voxel == VoxelKey{3, 3, 8});
    CHECK(unknown.range_m == doctest::Approx(0.25));
    up.through_unknown = true;
    const RayEnd nothing = only_end(fleet, up);
    CHECK(nothing.code == VoxelCode::free());
    CHECK_FALSE(nothing.voxel.has_value());
    CHECK(nothing.range_m == 3.0);
    up.through_unknown = false;
    up.max_range_m = 0.2;
    CHECK_FALSE(only_end(fleet, up).voxel.has_value());
  }
}

TEST_CASE("in the merge-map rays meet what others know, in the own layer they do not") {
  FleetMap fleet = fleet_map({false, false});
  tick(fleet, {floor_block({0, 0, 0}, 3)});
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 9)}), "old.layer").has_value());
  const Eigen::Vector3d slope{1.0, 0.0, -0.5};
  const RayEnd merged = only_end(fleet, rays_from({0.75, 0.35, 0.25}, {slope}));
  CHECK(merged.code == VoxelCode::occupied(9, false));
  CHECK(merged.voxel == VoxelKey{10, 3, 0});
  const RayEnd own = only_end(fleet, rays_from({0.75, 0.35, 0.25}, {slope}, MapSource::kSelf));
  CHECK(own.code == VoxelCode{});
  CHECK(own.voxel == VoxelKey{8, 3, 2});
}

TEST_CASE("many rays at once end where each alone does, at the voxel that a fine walk finds") {
  FleetMap fleet = fleet_map({false, false});
  tick(fleet, {floor_block({0, 0, 0}, 3), floor_block({1, 0, 0}, 4), floor_block({0, 1, 0}, 5)});
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < 200; ++i) {
    const double turn = 0.031 * i;
    directions.push_back({std::cos(turn), std::sin(turn), -0.05 - 0.004 * i});
  }
  const Eigen::Vector3d origin{0.41, 0.43, 0.47};
  const auto answer = fleet.rays(rays_from(origin, directions));
  REQUIRE(answer.has_value());
  REQUIRE(answer->ends.size() == directions.size());
  const Lattice lattice(0.1);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const RayEnd& end = answer->ends[i];
    REQUIRE(end.voxel.has_value());
    const Eigen::Vector3d entry = origin + end.range_m * directions[i].normalized();
    const Eigen::Vector3d centre(lattice.centre_m(end.voxel->x), lattice.centre_m(end.voxel->y),
                                 lattice.centre_m(end.voxel->z));
    CHECK((entry - centre).cwiseAbs().maxCoeff() == doctest::Approx(0.05).epsilon(1e-3));
    for (double range_m = 0.0; range_m < end.range_m - 1e-3; range_m += 0.01) {
      const Eigen::Vector3d before =
          kFarOrigin.position_map(0.1) + origin + range_m * directions[i].normalized();
      CellsQuestion cell;
      cell.source = MapSource::kMerge;
      cell.low_map = before;
      cell.high_map = before;
      cell.size = 16U;
      REQUIRE(fleet.cells(cell)->cells.front().code == VoxelCode::free());
    }
  }
}

TEST_CASE("rays without a map, beyond its keys, or too long together are refused") {
  FleetMap fleet = fleet_map();
  RaysQuestion question = rays_from({0.35, 0.35, 0.55}, {{0, 0, -1}});
  CHECK(fleet.rays(question).error().find("no map yet") != std::string::npos);
  tick(fleet, {floor_block({0, 0, 0}, 3)});
  CHECK(fleet.rays(question).has_value());
  question.max_range_m = 5000.0;
  CHECK(fleet.rays(question).error().find("leaves the map's keys") != std::string::npos);
  question.max_range_m = 20.0;
  question.rays.resize(RaysQuestion::kRaysMax, question.rays.front());
  CHECK(fleet.rays(question).error().find("too long") == std::string::npos);
  CHECK(fleet.rays(question).error().find("131072 voxels") != std::string::npos);
}

}  // namespace warren
