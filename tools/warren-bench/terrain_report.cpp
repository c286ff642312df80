// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/warren-bench/machine.hpp"
#include "tools/warren-bench/terrain_bench.hpp"

namespace warren {

std::string to_text(const TerrainResult& r) {
  const Machine machine = this_machine();
  const std::size_t scans = r.scans == 0 ? 1 : r.scans;
  std::string text = fmt::format("{} ({}), {}\n", machine.cpu, machine.cpu_level, machine.build);
  text += fmt::format("{} scans, {} points each, {} after reduction ({} by PCL)\n", r.scans,
                      r.points / scans, r.points_reduced / scans, r.points_reduced_pcl / scans);
  text += fmt::format("{:<24}{:>16}\n", "", "CPU ms/scan");
  text += fmt::format("{:<24}{:>16.2f}\n", "ours, paper", r.ours_cpu_ms_per_scan);
  text += fmt::format("{:<24}{:>16.2f}\n", "ours, robust", r.ours_robust_cpu_ms_per_scan);
  text += fmt::format("{:<24}{:>16.2f}\n", "PCL VoxelGrid", r.pcl_reduction_cpu_ms_per_scan);
  text += fmt::format("{:<24}{:>16.2f}\n", "PCL NormalEstimation", r.pcl_normals_cpu_ms_per_scan);
  text += fmt::format("{:<24}{:>16.1f}\n", "ratio, paper", r.ratio_cpu());
  const PlaneAgreement& a = r.agreement;
  text += fmt::format(
      "normals within 0.1 deg {:.6f} (rings and all {:.6f}), curvature within 1e-4 {:.6f}\n",
      a.normals_share(), a.all_normals_share(), a.curvature_share());
  for (std::size_t i = 0; i < kEvidenceCount; ++i) {
    text += fmt::format("{} {}{}", name_of(static_cast<Evidence>(i)), r.evidence[i],
                        i + 1 < kEvidenceCount ? ", " : "\n");
  }
  return text;
}

std::string to_json(const TerrainResult& r) {
  const Machine machine = this_machine();
  nlohmann::ordered_json evidence;
  for (std::size_t i = 0; i < kEvidenceCount; ++i) {
    evidence[name_of(static_cast<Evidence>(i))] = r.evidence[i];
  }
  const PlaneAgreement& a = r.agreement;
  const nlohmann::ordered_json json = {
      {"benchmark", "terrain"},
      {"machine",
       {{"cpu", machine.cpu}, {"cpu_level", machine.cpu_level}, {"build", machine.build}}},
      {"scans", r.scans},
      {"points", r.points},
      {"ours",
       {{"cpu_ms_per_scan", r.ours_cpu_ms_per_scan},
        {"robust_cpu_ms_per_scan", r.ours_robust_cpu_ms_per_scan},
        {"points_reduced", r.points_reduced},
        {"evidence", evidence}}},
      {"pcl",
       {{"cpu_ms_per_scan", r.pcl_cpu_ms_per_scan()},
        {"reduction_cpu_ms_per_scan", r.pcl_reduction_cpu_ms_per_scan},
        {"normals_cpu_ms_per_scan", r.pcl_normals_cpu_ms_per_scan},
        {"points_reduced", r.points_reduced_pcl},
        {"scans_refused", r.scans_refused_by_pcl}}},
      {"ratio_cpu", r.ratio_cpu()},
      {"points_compared", a.points},
      {"normals_within_0p1_deg", a.normals_share()},
      {"normals_within_0p1_deg_rings_and_all", a.all_normals_share()},
      {"curvature_within_1e_4", a.curvature_share()}};
  return json.dump(2);
}

}  // namespace warren
