// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "core/terrain/terrain_judge.hpp"
#include "tools/warren-bench/scan_sequence.hpp"

namespace warren {

// Our planes beside PCL's on the same reduced clouds, point by point. Of points that are judged: a
// ring's normal is anything, and PCL's, in single precision, is often another than ours.
struct PlaneAgreement {
  std::uint64_t points = 0;
  std::uint64_t normals_within_0p1_deg = 0;
  std::uint64_t curvature_within_1e_4 = 0;
  // Rings and all.
  std::uint64_t all_points = 0;
  std::uint64_t all_normals_within_0p1_deg = 0;

  void add(const PlaneAgreement& other) {
    points += other.points;
    normals_within_0p1_deg += other.normals_within_0p1_deg;
    curvature_within_1e_4 += other.curvature_within_1e_4;
    all_points += other.all_points;
    all_normals_within_0p1_deg += other.all_normals_within_0p1_deg;
  }
  double normals_share() const { return share(normals_within_0p1_deg, points); }
  double curvature_share() const { return share(curvature_within_1e_4, points); }
  double all_normals_share() const { return share(all_normals_within_0p1_deg, all_points); }

 private:
  static double share(std::uint64_t part, std::uint64_t all) {
    return all == 0 ? 1.0 : static_cast<double>(part) / static_cast<double>(all);
  }
};

// Lets PCL fit planes to the points that the judge has just reduced.
PlaneAgreement compare_with_pcl(const TerrainJudge& judge);

struct TerrainResult {
  std::size_t scans = 0;
  std::size_t points = 0;
  std::size_t points_reduced = 0;
  std::size_t points_reduced_pcl = 0;
  // Scans that PCL's grid gave back as they were, too wide for its 32-bit cell numbers; it then
  // fits planes to our reduced cloud.
  std::size_t scans_refused_by_pcl = 0;
  EvidenceCounts evidence{};
  // CPU of one thread, user and system. Ours judges (reduction, planes and cost), PCL reduces and
  // fits planes.
  double ours_cpu_ms_per_scan = 0.0;
  double ours_robust_cpu_ms_per_scan = 0.0;
  double pcl_reduction_cpu_ms_per_scan = 0.0;
  double pcl_normals_cpu_ms_per_scan = 0.0;
  PlaneAgreement agreement;

  double pcl_cpu_ms_per_scan() const {
    return pcl_reduction_cpu_ms_per_scan + pcl_normals_cpu_ms_per_scan;
  }
  double ratio_cpu() const {
    return ours_cpu_ms_per_scan == 0.0 ? 0.0 : pcl_cpu_ms_per_scan() / ours_cpu_ms_per_scan;
  }
};

// Judges the scans by the paper's profile, and lets PCL do its part of the same, in this process,
// scan by scan in turn.
TerrainResult bench_terrain(const ScanSequence& sequence);

std::string to_text(const TerrainResult& result);
std::string to_json(const TerrainResult& result);

}  // namespace warren
