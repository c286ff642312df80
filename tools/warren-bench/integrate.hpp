// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/voxel/self_map.hpp"
#include "tools/warren-bench/octomap_peer.hpp"
#include "tools/warren-bench/scan_sequence.hpp"

namespace warren {

struct Cost {
  double cpu_ms_per_scan = 0.0;  // user CPU, one thread
  double heap_mb = 0.0;          // peak of what was live, 10^6 bytes
};

struct IntegrateResult {
  std::size_t scans = 0;
  std::size_t points = 0;
  Cost ours;
  Cost octomap;               // of the faster of its two modes
  bool octomap_lazy = false;  // which that was
  double octomap_other_cpu_ms_per_scan = 0.0;
  MapAgreement agreement;
  // Our cost of the same scene in a map of so many scenes over that in an empty map.
  std::optional<double> growth_cost_share;
};

struct IntegrateOptions {
  SelfMapConfig map;
  int growth_copies = 0;  // 0: do not measure
};

// Integrates the sequence with ours and with OctoMap, in this process, one after the other.
IntegrateResult bench_integrate(const ScanSequence& sequence, const IntegrateOptions& options);

std::string to_text(const IntegrateResult& result);
std::string to_json(const IntegrateResult& result, const IntegrateOptions& options,
                    std::optional<double> max_range_m);

}  // namespace warren
