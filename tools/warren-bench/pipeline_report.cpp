// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/warren-bench/machine.hpp"
#include "tools/warren-bench/pipeline_bench.hpp"

namespace warren {

std::string to_text(const PipelineResult& r) {
  const Machine machine = this_machine();
  const auto line = [](const char* what, double ms) {
    return fmt::format("{:<32}{:>12.2f}\n", what, ms);
  };
  std::string text = fmt::format("{} ({}), {}\n", machine.cpu, machine.cpu_level, machine.build);
  text += fmt::format("{} scans, {} points each\n", r.scans,
                      r.points / std::max(r.scans, std::size_t{1}));
  text += fmt::format("{:<32}{:>12}\n", "", "CPU ms/scan");
  text += line("ours, all", r.ours_cpu_ms);
  text += line("PCL VoxelGrid", r.pcl_reduction_cpu_ms);
  text += line("PCL NormalEstimation", r.pcl_normals_cpu_ms);
  text += line(r.octomap_lazy ? "OctoMap, lazy_eval" : "OctoMap", r.octomap_cpu_ms);
  text +=
      line(r.octomap_lazy ? "(OctoMap, eager)" : "(OctoMap, lazy_eval)", r.octomap_other_cpu_ms);
  text += fmt::format("{:<32}{:>12.1f}\n", "ratio", r.ratio_cpu());
  text += fmt::format("{} of {} occupied voxels have a cost\n", r.voxels_costed, r.voxels_occupied);
  if (r.scans_refused_by_pcl > 0) {
    text += fmt::format("PCL's grid refused {} scans\n", r.scans_refused_by_pcl);
  }
  return text;
}

std::string to_json(const PipelineResult& r, const PipelineOptions& options,
                    std::optional<double> max_range_m) {
  const Machine machine = this_machine();
  const nlohmann::ordered_json json = {
      {"benchmark", "pipeline"},
      {"machine",
       {{"cpu", machine.cpu}, {"cpu_level", machine.cpu_level}, {"build", machine.build}}},
      {"resolution_m", options.map.resolution_m},
      {"max_range_m", max_range_m ? nlohmann::ordered_json(*max_range_m) : nullptr},
      {"profile", options.profile},
      {"scans", r.scans},
      {"points", r.points},
      {"ours", {{"cpu_ms_per_scan", r.ours_cpu_ms}}},
      {"pcl",
       {{"reduction_cpu_ms_per_scan", r.pcl_reduction_cpu_ms},
        {"normals_cpu_ms_per_scan", r.pcl_normals_cpu_ms},
        {"scans_refused", r.scans_refused_by_pcl}}},
      {"octomap",
       {{"cpu_ms_per_scan", r.octomap_cpu_ms},
        {"lazy_eval", r.octomap_lazy},
        {"other_mode_cpu_ms_per_scan", r.octomap_other_cpu_ms}}},
      {"ratio_cpu", r.ratio_cpu()},
      {"voxels_occupied", r.voxels_occupied},
      {"voxels_costed", r.voxels_costed}};
  return json.dump(2);
}

}  // namespace warren
