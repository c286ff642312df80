// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/terrain/terrain_judge.hpp"
#include "core/terrain/voxel_cost_gatherer.hpp"
#include "core/voxel/scan.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

struct PipelineReport {
  IntegrationReport integration;
  TerrainReport terrain;
  CostFusionReport costs;
};

// A scan's whole way into the self-map: its rays are integrated, its ground is reduced and judged,
// and each voxel's cost is fused, each once. Reads the scan's points where they are. One thread.
class ScanPipeline {
 public:
  explicit ScanPipeline(const TerrainConfig& terrain) : judge_(terrain) {}

  // `gravity` is of unit length, in the layer frame. What lies past the scan's max range is not
  // judged.
  PipelineReport run(const LayerScan& scan, const Point3f& gravity, SelfMap& map);

  const TerrainConfig& terrain() const { return judge_.config(); }

 private:
  TerrainJudge judge_;
  VoxelCostGatherer gatherer_;
};

}  // namespace warren
