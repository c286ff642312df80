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

// PCL's part: reduction and planes, of what lies within range as ours.
class PclPart {
 public:
  PclPart(const TerrainConfig& config, PipelineResult& result) : config_(config), result_(result) {}

  void run(std::span<const Point3f> points_in_range) {
    const auto cloud = PclTerrainPeer::make_cloud(points_in_range);
    const auto reduced =
        reduction_.time([&] { return PclTerrainPeer::reduce(*cloud, config_.cell_m); });
    if (PclTerrainPeer::size_of(*reduced) == points_in_range.size()) ++result_.scans_refused_by_pcl;
    const auto k = static_cast<int>(config_.neighbourhood.neighbours);
    normals_.time([&] { return PclTerrainPeer::fit_planes(*reduced, k).size(); });
  }
  void tell() {
    result_.pcl_reduction_cpu_ms = reduction_.ms_per(result_.scans);
    result_.pcl_normals_cpu_ms = normals_.ms_per(result_.scans);
  }

 private:
  const TerrainConfig& config_;
  PipelineResult& result_;
  Stopwatch reduction_;
  Stopwatch normals_;
};

class OctomapPart {
 public:
  explicit OctomapPart(const SelfMapConfig& config) : eager_(config, false), lazy_(config, true) {}

  void run(const LayerScan& scan) {
    const auto cloud = OctomapPeer::make_cloud(scan);
    eager_time_.time([&] { eager_.insert(*cloud); });
    lazy_time_.time([&] { lazy_.insert(*cloud); });
  }
  void tell(PipelineResult& result) {
    lazy_time_.time([&] { lazy_.finish(); });
    const double eager_ms = eager_time_.ms_per(result.scans);
    const double lazy_ms = lazy_time_.ms_per(result.scans);
    result.octomap_lazy = lazy_ms < eager_ms;
    result.octomap_cpu_ms = std::min(lazy_ms, eager_ms);
    result.octomap_other_cpu_ms = std::max(lazy_ms, eager_ms);
  }

 private:
  OctomapPeer eager_;
  OctomapPeer lazy_;
  Stopwatch eager_time_;
  Stopwatch lazy_time_;
};

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
  ScanSequence in_range = sequence;
  in_range.leave_out_beyond_max_range();

  SelfMap map(options.map);
  ScanPipeline pipeline(config_of(options.profile));
  Stopwatch ours;
  PclPart pcl(pipeline.terrain(), result);
  OctomapPart octomap(options.map);
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    ours.time([&] { pipeline.run(sequence.scan(i), kGravity, map); });
    pcl.run(in_range.scans[i].points_layer);
    octomap.run(sequence.scan(i));
  }
  result.ours_cpu_ms = ours.ms_per(result.scans);
  pcl.tell();
  octomap.tell(result);
  count_voxels(map, result);
  return result;
}

}  // namespace warren
