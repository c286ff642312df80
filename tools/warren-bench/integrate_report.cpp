// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/warren-bench/integrate.hpp"
#include "tools/warren-bench/machine.hpp"

namespace warren {
namespace {

double ratio(double peer, double ours) { return ours > 0.0 ? peer / ours : 0.0; }

}  // namespace

std::string to_text(const IntegrateResult& r) {
  const Machine machine = this_machine();
  const MapAgreement& a = r.agreement;
  std::string text = fmt::format("{}, {}, {}\n", machine.cpu, machine.cpu_level, machine.build);
  text += fmt::format("{} scans, {} points each\n", r.scans, r.scans == 0 ? 0 : r.points / r.scans);
  text += fmt::format("{:<10}{:>16}{:>12}{:>14}{:>14}\n", "", "CPU ms/scan", "heap MB", "free",
                      "occupied");
  text += fmt::format("{:<10}{:>16.2f}{:>12.2f}{:>14}{:>14}\n", "ours", r.ours.cpu_ms_per_scan,
                      r.ours.heap_mb, a.free_ours, a.occupied_ours);
  text += fmt::format("{:<10}{:>16.2f}{:>12.2f}{:>14}{:>14}   (lazy_eval {}; {}: {:.2f} ms)\n",
                      "octomap", r.octomap.cpu_ms_per_scan, r.octomap.heap_mb, a.free_peer,
                      a.occupied_peer, r.octomap_lazy ? "on" : "off", r.octomap_lazy ? "off" : "on",
                      r.octomap_other_cpu_ms_per_scan);
  text += fmt::format("{:<10}{:>16.1f}{:>12.1f}\n", "ratio",
                      ratio(r.octomap.cpu_ms_per_scan, r.ours.cpu_ms_per_scan),
                      ratio(r.octomap.heap_mb, r.ours.heap_mb));
  text += fmt::format("IoU free {:.7f}, occupied {:.7f}{}\n", a.iou_free(), a.iou_occupied(),
                      a.identical() ? ": identical" : "");
  if (r.growth_cost_share) {
    text +=
        fmt::format("cost in a grown map: {:.2f} of that in an empty one\n", *r.growth_cost_share);
  }
  return text;
}

std::string to_json(const IntegrateResult& r, const IntegrateOptions& options,
                    std::optional<double> max_range_m) {
  const Machine machine = this_machine();
  const MapAgreement& a = r.agreement;
  nlohmann::ordered_json json = {
      {"benchmark", "integrate"},
      {"machine",
       {{"cpu", machine.cpu}, {"cpu_level", machine.cpu_level}, {"build", machine.build}}},
      {"resolution_m", options.map.resolution_m},
      {"max_range_m", max_range_m ? nlohmann::ordered_json(*max_range_m) : nullptr},
      {"sensor_model", options.map.sensor_model == SensorModel::field() ? "field" : "default"},
      {"one_ray_per_end_voxel", options.map.one_ray_per_end_voxel},
      {"scans", r.scans},
      {"points", r.points},
      {"ours", {{"cpu_ms_per_scan", r.ours.cpu_ms_per_scan}, {"heap_mb", r.ours.heap_mb}}},
      {"octomap",
       {{"cpu_ms_per_scan", r.octomap.cpu_ms_per_scan},
        {"heap_mb", r.octomap.heap_mb},
        {"lazy_eval", r.octomap_lazy},
        {"other_mode_cpu_ms_per_scan", r.octomap_other_cpu_ms_per_scan},
        {"voxels_occupied", a.occupied_peer},
        {"voxels_free", a.free_peer}}},
      {"ratio_cpu", ratio(r.octomap.cpu_ms_per_scan, r.ours.cpu_ms_per_scan)},
      {"ratio_heap", ratio(r.octomap.heap_mb, r.ours.heap_mb)},
      {"iou_occupied", a.iou_occupied()},
      {"iou_free", a.iou_free()},
      {"identical", a.identical()},
      {"voxels_occupied", a.occupied_ours},
      {"voxels_free", a.free_ours}};
  if (r.growth_cost_share) json["growth_cost_share"] = *r.growth_cost_share;
  return json.dump(2);
}

}  // namespace warren
