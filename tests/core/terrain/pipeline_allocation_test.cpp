// SPDX-License-Identifier: Apache-2.0
// A binary of its own: it counts every allocation of the process.
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <vector>

#include <doctest/doctest.h>

#include "core/terrain/scan_pipeline.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace

void* operator new(std::size_t bytes) {
  ++allocations;
  void* const memory = std::malloc(bytes == 0 ? 1 : bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

using namespace warren;

TEST_CASE("a scan of ground seen before allocates nothing") {
  std::vector<Point3f> points;
  for (int i = 0; i < 60000; ++i) {
    const float angle = 0.01F * static_cast<float>(i);
    const float range = 1.0F + 1e-4F * static_cast<float>(i);
    points.push_back({range * std::cos(angle), range * std::sin(angle), -0.5F});
  }
  SelfMap map({});
  ScanPipeline pipeline(TerrainConfig::robust());
  const LayerScan scan{{}, points, 20.0, {}};
  const Point3f gravity{0.0F, 0.0F, -1.0F};
  const std::size_t before_first = allocations;
  for (int i = 0; i < 80; ++i) pipeline.run(scan, gravity, map);  // until every voxel is settled
  CHECK(allocations > before_first);                              // the count counts
  const std::size_t before = allocations;
  const PipelineReport report = pipeline.run(scan, gravity, map);
  CHECK(allocations - before == 0);
  CHECK(report.integration.rays == points.size());
  CHECK(report.costs.voxels_fused > 1000);
}
