// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/terrain/terrain_judge.hpp"
#include "core/voxel/self_map.hpp"
#include "tools/warren-bench/scan_sequence.hpp"

namespace warren {

struct PipelineOptions {
  SelfMapConfig map;
  std::string profile = "robust";  // of the terrain: paper or robust
};

// CPU per scan of one thread, user and system, in milliseconds.
struct PipelineResult {
  std::size_t scans = 0;
  std::size_t points = 0;
  double ours_cpu_ms = 0.0;  // rays, ground and fused costs
  double pcl_reduction_cpu_ms = 0.0;
  double pcl_normals_cpu_ms = 0.0;
  double octomap_cpu_ms = 0.0;        // of the faster of its two modes
  double octomap_other_cpu_ms = 0.0;  // of the other
  bool octomap_lazy = false;          // which the faster was
  // Scans that PCL's grid gave back as they were, too wide for its 32-bit cell numbers.
  std::size_t scans_refused_by_pcl = 0;
  std::size_t voxels_occupied = 0;
  std::size_t voxels_costed = 0;

  double peer_cpu_ms() const { return pcl_reduction_cpu_ms + pcl_normals_cpu_ms + octomap_cpu_ms; }
  double ratio_cpu() const { return ours_cpu_ms > 0.0 ? peer_cpu_ms() / ours_cpu_ms : 0.0; }
};

// Takes every scan through our whole pipeline, and through the same work with libraries: voxel grid
// and 24-neighbour normals by PCL, rays by OctoMap. In this process, one after the other. The
// peer's slopes and its fusion of costs are left out: it is spared that work.
PipelineResult bench_pipeline(const ScanSequence& sequence, const PipelineOptions& options);

std::string to_text(const PipelineResult& result);
std::string to_json(const PipelineResult& result, const PipelineOptions& options,
                    std::optional<double> max_range_m);

}  // namespace warren
