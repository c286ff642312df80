// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "daemon/fleet/cells_answer.hpp"
#include "tests/daemon/small_fleet.hpp"

namespace warren {

using namespace test;

namespace {

// Around block (x, 0, 0) of the layer: `low` and `high` are metres from its corner.
CellsQuestion box_at(std::int32_t block_x, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     MapSource source) {
  const Eigen::Vector3d corner =
      kFarOrigin.position_map(0.1) + Eigen::Vector3d(0.8 * block_x, 0, 0);
  CellsQuestion question;
  question.source = source;
  question.low_map = corner + low;
  question.high_map = corner + high;
  question.size = 16U;
  return question;
}

CellsQuestion point_at(std::int32_t block_x, MapSource source) {
  return box_at(block_x, {0.35, 0.35, 0.05}, {0.35, 0.35, 0.05}, source);
}

CodeNode cell(FleetMap& fleet, CellsQuestion question, std::uint32_t depth) {
  question.size = depth;
  const auto answer = fleet.cells(question);
  REQUIRE(answer.has_value());
  REQUIRE(answer->cells.size() == 1);
  return answer->cells.front();
}

}  // namespace

TEST_CASE("a coarser cell is as bad as the worst voxel in it, here and in the merge-map") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 3)});
  REQUIRE(fleet.load(earlier_layer({floor_block({1, 0, 0}, 9)}), "old.layer").has_value());
  for (const MapSource source : {MapSource::kSelf, MapSource::kMerge}) {
    CHECK(cell(fleet, point_at(0, source), 16).code == VoxelCode::occupied(3, false));
    CHECK_FALSE(cell(fleet, point_at(0, source), 16).has_children);
    CHECK(cell(fleet, point_at(0, source), 13).code == VoxelCode::occupied(3, false));
    CHECK(cell(fleet, point_at(0, source), 13).has_children);
  }
  CHECK(cell(fleet, point_at(1, MapSource::kSelf), 16).code == VoxelCode{});
  CHECK(cell(fleet, point_at(1, MapSource::kMerge), 16).code == VoxelCode::occupied(9, false));
  CHECK(cell(fleet, point_at(0, MapSource::kSelf), 0).code == VoxelCode::occupied(3, false));
  CHECK(cell(fleet, point_at(0, MapSource::kMerge), 0).code == VoxelCode::occupied(9, false));
}

TEST_CASE("cells of at least a given edge lie on the octree's borders") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 3)});
  CellsQuestion question = box_at(0, {0.05, 0.05, 0.05}, {0.75, 0.15, 0.05}, MapSource::kSelf);
  for (const auto& [edge_m, told_m, cells] :
       {std::tuple{0.05, 0.1, 16}, {0.1, 0.1, 16}, {0.11, 0.2, 4}, {0.4, 0.4, 2}, {0.5, 0.8, 1}}) {
    question.size = edge_m;
    const auto answer = fleet.cells(question);
    REQUIRE(answer.has_value());
    CHECK(answer->cell_m() == doctest::Approx(told_m));
    CHECK(answer->cells.size() == static_cast<std::size_t>(cells));
    const Eigen::Vector3d low = answer->low_map(answer->cells.front());
    CHECK((low - kFarOrigin.position_map(0.1)).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("no map, a place outside the keys, too many or too large cells: each is said") {
  FleetMap fleet = fleet_map();
  const auto error_of = [&](const CellsQuestion& question) {
    const auto answer = fleet.cells(question);
    REQUIRE_FALSE(answer.has_value());
    return answer.error();
  };
  CHECK(error_of(point_at(0, MapSource::kSelf)).find("no map yet") != std::string::npos);
  CHECK(error_of(point_at(0, MapSource::kMerge)).find("no map yet") != std::string::npos);
  tick(fleet, {floor_block({0, 0, 0}, 3)});
  CHECK(error_of(point_at(1 << 20, MapSource::kSelf)).find("outside") != std::string::npos);
  const CellsQuestion box = box_at(0, {0.0, 0.0, 0.0}, {10.0, 10.0, 10.0}, MapSource::kMerge);
  CHECK(error_of(box).find("at most 4096") != std::string::npos);
  CellsQuestion large = point_at(0, MapSource::kSelf);
  large.size = 1e9;
  CHECK(error_of(large).find("larger than") != std::string::npos);
}

}  // namespace warren
