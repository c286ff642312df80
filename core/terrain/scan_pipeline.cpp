// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/scan_pipeline.hpp"

namespace warren {

PipelineReport ScanPipeline::run(const LayerScan& scan, const Point3f& gravity, SelfMap& map) {
  PipelineReport report;
  report.integration = map.integrate(scan);
  TerrainScan ground{scan.points_layer, scan.origin_layer, gravity, std::nullopt};
  if (scan.max_range_m) ground.max_range_m = static_cast<float>(*scan.max_range_m);
  const auto judged = judge_.judge(ground);
  report.terrain = judge_.report();
  report.costs = map.fuse_costs(gatherer_.gather(judged, scan.origin_layer, map.lattice()));
  return report;
}

}  // namespace warren
