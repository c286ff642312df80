// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/warren-bench/wire_catchup.hpp"
#include "tools/warren-bench/wire_growth.hpp"
#include "tools/warren-bench/wire_live.hpp"
#include "tools/warren-bench/wire_query.hpp"

namespace warren {

struct WireResult {
  std::size_t scans = 0;
  std::size_t ticks = 0;
  std::size_t scans_per_tick = 0;
  std::uint64_t voxels_known = 0;
  std::uint64_t blocks = 0;
  LiveResult live;
  RulesResult rules;
  WireTraffic snapshot;
  std::vector<CatchUp> catch_ups;
  double publish_share = 0.0;
  // Bytes per known voxel of the layer that was published, of a copy that followed it, and of one
  // fed in bulk.
  double memory_origin = 0.0;
  double memory_copy = 0.0;
  double memory_bulk_copy = 0.0;
  QueryCost query;
  std::optional<WireGrowth> growth;

  double per_changed_voxel(std::uint64_t bytes) const {
    return bits_per(bytes, live.voxels_changed);
  }
  double per_known_voxel(std::uint64_t bytes) const { return bits_per(bytes, voxels_known); }
  double catchup_ratio_max() const;
  double catchup_relay_ratio_max() const;

 private:
  static double bits_per(std::uint64_t bytes, std::uint64_t voxels) {
    return voxels == 0 ? 0.0 : 8.0 * static_cast<double>(bytes) / static_cast<double>(voxels);
  }
};

// Maps the sequence, and tells of the map as it grows over a wire that loses nothing: what it takes
// in bytes and in CPU, beside other ways to do the same. The error names a copy that did not end
// equal to its origin.
tl::expected<WireResult, std::string> bench_wire(const ScanSequence& sequence,
                                                 const WireOptions& options);

std::string to_text(const WireResult& result);
std::string to_json(const WireResult& result, const WireOptions& options,
                    std::optional<double> max_range_m);

}  // namespace warren
