// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/pipeline_bench.hpp"

#include <algorithm>

#include "core/terrain/scan_pipeline.hpp"
#include "tools/warren-bench/octomap_peer.hpp"
#include "tools/warren-bench/pcl_terrain_peer.hpp"
#include "tools/warren-bench/stopwatch.hpp"

namespace warren {
namespace {

constexpr Point3f kGravity{0.0F, 0.0F, -1.0F};

void run_ours(const ScanSequence& sequence, ScanPipeline& pipeline, SelfMap& map,
              PipelineResult& result) {
  Stopwatch watch;
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    watch.time([&] { pipeline.run(sequence.scan(i), kGravity, map); });
  }
  result.ours_cpu_ms = watch.ms_per(result.scans);
}

// Reduction and planes, of what lies within range as ours.
void run_pcl(ScanSequence sequence, const TerrainConfig& config, PipelineResult& result) {
  sequence.leave_out_beyond_max_range();
  const auto k = static_cast<int>(config.neighbourhood.neighbours);
  Stopwatch reduction;
  Stopwatch normals;
  for (const auto& scan : sequence.scans) {
    const auto cloud = PclTerrainPeer::make_cloud(scan.points_layer);
    const auto reduced =
        reduction.time([&] { return PclTerrainPeer::reduce(*cloud, config.cell_m); });
    if (PclTerrainPeer::size_of(*reduced) == scan.points_layer.size()) {
      ++result.scans_refused_by_pcl;
    }
    normals.time([&] { return PclTerrainPeer::fit_planes(*reduced, k).size(); });
  }
  result.pcl_reduction_cpu_ms = reduction.ms_per(result.scans);
  result.pcl_normals_cpu_ms = normals.ms_per(result.scans);
}

double octomap_cpu_ms(const ScanSequence& sequence, const SelfMapConfig& config, bool lazy) {
  OctomapPeer peer(config, lazy);
  Stopwatch watch;
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    const auto cloud = OctomapPeer::make_cloud(sequence.scan(i));
    watch.time([&] { peer.insert(*cloud); });
  }
  watch.time([&] { peer.finish(); });
  return watch.ms_per(sequence.scans.size());
}

void run_octomap(const ScanSequence& sequence, const SelfMapConfig& config,
                 PipelineResult& result) {
  const double eager_ms = octomap_cpu_ms(sequence, config, false);
  const double lazy_ms = octomap_cpu_ms(sequence, config, true);
  result.octomap_lazy = lazy_ms < eager_ms;
  result.octomap_cpu_ms = std::min(lazy_ms, eager_ms);
  result.octomap_other_cpu_ms = std::max(lazy_ms, eager_ms);
}

TerrainConfig config_of(const std::string& profile) {
  return profile == "paper" ? TerrainConfig::paper() : TerrainConfig::robust();
}

void count_voxels(const SelfMap& map, PipelineResult& result) {
  map.for_each_known_voxel(KeyBox{}, [&](const VoxelKey& key, VoxelState state, float) {
    if (state != VoxelState::kOccupied) return;
    ++result.voxels_occupied;
    if (map.cost(key)) ++result.voxels_costed;
  });
}

}  // namespace

PipelineResult bench_pipeline(const ScanSequence& sequence, const PipelineOptions& options) {
  PipelineResult result;
  result.scans = sequence.scans.size();
  result.points = sequence.point_count();
  SelfMap map(options.map);
  ScanPipeline pipeline(config_of(options.profile));
  run_ours(sequence, pipeline, map, result);
  run_pcl(sequence, pipeline.terrain(), result);
  run_octomap(sequence, options.map, result);
  count_voxels(map, result);
  return result;
}

}  // namespace warren
