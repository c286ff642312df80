// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/integrate.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "tools/warren-bench/cpu_clock.hpp"
#include "tools/warren-bench/heap_meter.hpp"

namespace warren {
namespace {

constexpr float kCopyDistanceM = 128.0F;
constexpr double kMegabyte = 1e6;

double ms_per_scan(double seconds, std::size_t scans) {
  return scans == 0 ? 0.0 : 1e3 * seconds / static_cast<double>(scans);
}

double integrate_all(SelfMap& map, const ScanSequence& sequence) {
  const double start = user_cpu_s();
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) map.integrate(sequence.scan(i));
  return ms_per_scan(user_cpu_s() - start, sequence.scans.size());
}

// Clouds in OctoMap's type are made before the clock starts.
double insert_all(OctomapPeer& peer, const ScanSequence& sequence) {
  double seconds = 0.0;
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    const auto cloud = OctomapPeer::make_cloud(sequence.scan(i));
    const double start = user_cpu_s();
    peer.insert(*cloud);
    seconds += user_cpu_s() - start;
  }
  const double start = user_cpu_s();
  peer.finish();
  return ms_per_scan(seconds + user_cpu_s() - start, sequence.scans.size());
}

double heap_of_ours(const SelfMapConfig& config, const ScanSequence& sequence) {
  const HeapMeter meter;
  SelfMap map(config);
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) map.integrate(sequence.scan(i));
  return static_cast<double>(meter.peak_bytes()) / kMegabyte;
}

// The clouds are OctoMap's input, not its map: they exist before the meter.
double heap_of_octomap(const SelfMapConfig& config, bool lazy, const ScanSequence& sequence) {
  std::vector<std::shared_ptr<const OctomapPeer::Cloud>> clouds;
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    clouds.push_back(OctomapPeer::make_cloud(sequence.scan(i)));
  }
  const HeapMeter meter;
  OctomapPeer peer(config, lazy);
  for (const auto& cloud : clouds) peer.insert(*cloud);
  peer.finish();
  return static_cast<double>(meter.peak_bytes()) / kMegabyte;
}

double growth_cost_share(const SelfMapConfig& config, const ScanSequence& sequence, int copies) {
  SelfMap map(config);
  const double alone = integrate_all(map, sequence);
  double last = alone;
  for (int copy = 1; copy < copies; ++copy) {
    last = integrate_all(map, sequence.moved_by({kCopyDistanceM * static_cast<float>(copy), 0, 0}));
  }
  return last / alone;
}

}  // namespace

IntegrateResult bench_integrate(const ScanSequence& sequence, const IntegrateOptions& options) {
  IntegrateResult result;
  result.scans = sequence.scans.size();
  result.points = sequence.point_count();

  SelfMap map(options.map);
  result.ours.cpu_ms_per_scan = integrate_all(map, sequence);
  double eager_ms = 0.0;
  {
    OctomapPeer eager(options.map, false);
    eager_ms = insert_all(eager, sequence);
    result.agreement = eager.compare(map);
  }
  OctomapPeer lazy(options.map, true);
  const double lazy_ms = insert_all(lazy, sequence);
  result.octomap_lazy = lazy_ms < eager_ms;
  result.octomap.cpu_ms_per_scan = std::min(lazy_ms, eager_ms);
  result.octomap_other_cpu_ms_per_scan = std::max(lazy_ms, eager_ms);

  result.ours.heap_mb = heap_of_ours(options.map, sequence);
  result.octomap.heap_mb = heap_of_octomap(options.map, result.octomap_lazy, sequence);
  if (options.growth_copies > 1) {
    result.growth_cost_share = growth_cost_share(options.map, sequence, options.growth_copies);
  }
  return result;
}

}  // namespace warren
