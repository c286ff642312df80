// SPDX-License-Identifier: Apache-2.0
// Reduction and planes against PCL's.
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include "core/exchange/cloud_reader.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/simulated_scans.hpp"
#include "tools/warren-bench/pcl_terrain_peer.hpp"
#include "tools/warren-bench/terrain_bench.hpp"

using namespace warren;

namespace {

auto key_of(const Point3f& p) {
  return std::array{std::floor(p.x * 20.0F), std::floor(p.y * 20.0F), std::floor(p.z * 20.0F)};
}

// By cells: a centroid lies in the cell of its points, but for rounding at its border.
void check_same_reduction(const ReducedCloud& ours, const std::vector<Point3f>& input) {
  auto theirs =
      PclTerrainPeer::points_of(*PclTerrainPeer::reduce(*PclTerrainPeer::make_cloud(input), 0.05F));
  REQUIRE(ours.size() == theirs.size());
  std::vector<Point3f> mine;
  for (std::size_t i = 0; i < ours.size(); ++i) mine.push_back(ours.point(i));
  const auto by_cell = [](const Point3f& a, const Point3f& b) { return key_of(a) < key_of(b); };
  std::sort(mine.begin(), mine.end(), by_cell);
  std::sort(theirs.begin(), theirs.end(), by_cell);
  std::size_t different = 0;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    const float largest =
        std::max({std::abs(mine[i].x - theirs[i].x), std::abs(mine[i].y - theirs[i].y),
                  std::abs(mine[i].z - theirs[i].z)});
    if (largest > 2e-5F) ++different;
  }
  CHECK(different * 10000 <= mine.size());
}

// Planes through the same neighbours, by Eigen's solver in double.
double share_as_in_double(const TerrainJudge& judge) {
  const ReducedCloud& cloud = judge.reduced();
  const std::size_t k = judge.config().neighbourhood.neighbours;
  const auto listed = NeighbourSearch(judge.config().neighbourhood).list(cloud);
  std::size_t same = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Matrix3Xd neighbours(3, static_cast<Eigen::Index>(k));
    for (std::size_t j = 0; j < k; ++j) {
      const Point3f p = cloud.point(listed[i * k + j]);
      neighbours.col(static_cast<Eigen::Index>(j)) = Eigen::Vector3d(p.x, p.y, p.z);
    }
    const Eigen::Matrix3Xd centred = neighbours.colwise() - neighbours.rowwise().mean();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(centred * centred.transpose() /
                                                                static_cast<double>(k));
    const PlaneFits& ours = judge.planes();
    const Eigen::Vector3d normal(ours.normal_x[i], ours.normal_y[i], ours.normal_z[i]);
    if (normal.cross(solver.eigenvectors().col(0)).norm() < 1.7453e-3) ++same;
  }
  return static_cast<double>(same) / static_cast<double>(cloud.size());
}

void check_as_pcl(const std::vector<Point3f>& points, const Point3f& origin) {
  TerrainJudge judge(TerrainConfig::paper());
  judge.judge({points, origin});
  const PlaneAgreement a = compare_with_pcl(judge);
  const double in_double = share_as_in_double(judge);
  MESSAGE("COUNTS: ", a.points, " of ", judge.reduced().size(), " points: normals ",
          a.normals_share(), " (rings and all ", a.all_normals_share(), ", as in double ",
          in_double, "), curvature ", a.curvature_share());
  CHECK(a.points > judge.reduced().size() / 2);
  CHECK(a.normals_share() >= 0.999);
  CHECK(a.curvature_share() >= 0.999);
  // Where PCL and we differ, on rings, it is PCL's single precision.
  CHECK(in_double >= 0.999);
}

}  // namespace

TEST_CASE("a simulated room is reduced and fitted as by PCL") {
  const auto scan = test::scan_room({}, {64, 1024}, {0.3F, -0.2F, 0.1F}, 1);
  TerrainJudge judge(TerrainConfig::paper());
  judge.judge({scan.points_layer, scan.origin_layer});
  check_same_reduction(judge.reduced(), scan.points_layer);
  check_as_pcl(scan.points_layer, scan.origin_layer);
}

TEST_CASE("balm frames are reduced and fitted as by PCL") {
  const test::UnpackedData data("scans/balm_realworld/balm_every2nd_frame.tar.xz");
  if (!data.is_there()) return;
  const auto sequence = load_sequence(
      {data.folder(), data.folder() / "alidarPose.csv", PoseFormat::kMatrix4, 7}, 0.1, 20.0);
  REQUIRE_MESSAGE(sequence, sequence.error());
  for (std::size_t i = 0; i < sequence->scans.size(); i += 3) {
    const auto& scan = sequence->scans[i];
    check_as_pcl(scan.points_layer, scan.origin_layer);
  }
}

TEST_CASE("PCL's rooms are reduced and fitted as by PCL") {
  for (const char* file : {"scans/pcl/room_scan1.pcd", "scans/pcl/room_scan2.pcd"}) {
    const auto path = test::recorded_file(file);
    if (!path) return;
    const auto cloud = read_cloud(*path);
    REQUIRE_MESSAGE(cloud, cloud.error());
    TerrainJudge judge(TerrainConfig::paper());
    judge.judge({cloud->points, {}});
    check_same_reduction(judge.reduced(), cloud->points);
    check_as_pcl(cloud->points, {});
  }
}
