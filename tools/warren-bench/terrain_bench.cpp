// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/terrain_bench.hpp"

#include <cmath>

#include "tools/warren-bench/pcl_terrain_peer.hpp"
#include "tools/warren-bench/stopwatch.hpp"

namespace warren {
namespace {

constexpr double kSineOf0p1Deg = 1.7453283658983088e-3;
constexpr double kCurvatureTolerance = 1e-4;

// Sine of the angle between two lines; not a number if one of them is not.
double sine_between(const Point3f& a, const Point3f& b) {
  const auto cross = [](double p, double q, double r, double s) { return p * s - q * r; };
  const double x = cross(a.y, a.z, b.y, b.z);
  const double y = cross(a.z, a.x, b.z, b.x);
  const double z = cross(a.x, a.y, b.x, b.y);
  return std::sqrt(x * x + y * y + z * z);
}

std::vector<Point3f> points_of(const ReducedCloud& cloud) {
  std::vector<Point3f> points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cloud.point(i));
  return points;
}

// Buffers grow once in a daemon's life, not once in a benchmark of one scan.
void warm_up(const ScanSequence& sequence, TerrainJudge& paper, TerrainJudge& robust) {
  if (sequence.scans.empty()) return;
  const auto& scan = sequence.scans.front();
  paper.judge({scan.points_layer, scan.origin_layer});
  robust.judge({scan.points_layer, scan.origin_layer});
}

}  // namespace

PlaneAgreement compare_with_pcl(const TerrainJudge& judge) {
  const auto theirs =
      PclTerrainPeer::fit_planes(*PclTerrainPeer::make_cloud(points_of(judge.reduced())),
                                 static_cast<int>(judge.config().neighbourhood.neighbours));
  const PlaneFits& ours = judge.planes();
  PlaneAgreement agreement;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    if (judge.neighbourhoods().states[i] != NeighbourhoodState::kFound) continue;
    const double sine =
        sine_between({ours.normal_x[i], ours.normal_y[i], ours.normal_z[i]}, theirs[i].normal);
    const double difference =
        std::abs(static_cast<double>(ours.curvature[i]) - theirs[i].curvature);
    const bool same_normal = sine <= kSineOf0p1Deg;
    ++agreement.all_points;
    agreement.all_normals_within_0p1_deg += same_normal ? 1 : 0;
    if (judge.evidence()[i] != Evidence::kPlane) continue;
    ++agreement.points;
    agreement.normals_within_0p1_deg += same_normal ? 1 : 0;
    agreement.curvature_within_1e_4 += difference <= kCurvatureTolerance ? 1 : 0;
  }
  return agreement;
}

TerrainResult bench_terrain(const ScanSequence& sequence) {
  TerrainResult result;
  result.scans = sequence.scans.size();
  result.points = sequence.point_count();
  TerrainJudge paper(TerrainConfig::paper());
  TerrainJudge robust(TerrainConfig::robust());
  const auto k = static_cast<int>(paper.config().neighbourhood.neighbours);
  Stopwatch ours, ours_robust, pcl_reduction, pcl_normals;
  warm_up(sequence, paper, robust);
  for (const auto& scan : sequence.scans) {
    const TerrainScan terrain_scan{scan.points_layer, scan.origin_layer};
    result.points_reduced += ours.time([&] { return paper.judge(terrain_scan).size(); });
    ours_robust.time([&] { return robust.judge(terrain_scan).size(); });
    for (std::size_t i = 0; i < kEvidenceCount; ++i) {
      result.evidence[i] += paper.report().evidence[i];
    }
    result.agreement.add(compare_with_pcl(paper));

    const auto cloud = PclTerrainPeer::make_cloud(scan.points_layer);
    auto reduced =
        pcl_reduction.time([&] { return PclTerrainPeer::reduce(*cloud, paper.config().cell_m); });
    if (PclTerrainPeer::size_of(*reduced) == scan.points_layer.size()) {
      ++result.scans_refused_by_pcl;
      reduced = PclTerrainPeer::make_cloud(points_of(paper.reduced()));
    }
    result.points_reduced_pcl +=
        pcl_normals.time([&] { return PclTerrainPeer::fit_planes(*reduced, k).size(); });
  }
  result.ours_cpu_ms_per_scan = ours.ms_per(result.scans);
  result.ours_robust_cpu_ms_per_scan = ours_robust.ms_per(result.scans);
  result.pcl_reduction_cpu_ms_per_scan = pcl_reduction.ms_per(result.scans);
  result.pcl_normals_cpu_ms_per_scan = pcl_normals.ms_per(result.scans);
  return result;
}

}  // namespace warren
