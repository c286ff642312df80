// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/wire_bench.hpp"

#include <algorithm>

#include "core/layer/layer_counts.hpp"
#include "tools/warren-bench/wire_sweep.hpp"

namespace warren {
namespace {

constexpr LayerId kLayer{1, 1, 1};

double bytes_per(const Replica& layer, std::uint64_t voxels) {
  return voxels == 0 ? 0.0
                     : static_cast<double>(layer.memory_bytes()) / static_cast<double>(voxels);
}

// False if the copy did not end equal to the origin.
bool measure_snapshot(const Replica& origin, const WireOptions& options, WireResult& result) {
  const auto packets = sweep(origin, {}, options.packet_bytes);
  result.snapshot = {bytes_of(packets), packets.size()};
  Replica bulk(origin.id(), origin.resolution());
  if (!apply_all(bulk, packets) || !same_blocks(origin, bulk)) return false;
  result.memory_bulk_copy = bytes_per(bulk, result.voxels_known);
  return true;
}

tl::unexpected<std::string> not_equal(const char* which) {
  return tl::make_unexpected(std::string(which) + ": the copy is not what its origin published");
}

}  // namespace

double WireResult::catchup_ratio_max() const {
  double most = 0.0;
  for (const CatchUp& catch_up : catch_ups) most = std::max(most, catch_up.ratio());
  return most;
}

double WireResult::catchup_relay_ratio_max() const {
  double most = 0.0;
  for (const CatchUp& catch_up : catch_ups) most = std::max(most, catch_up.relay_ratio());
  return most;
}

tl::expected<WireResult, std::string> bench_wire(const ScanSequence& sequence,
                                                 const WireOptions& options) {
  WireResult result;
  const WireTape tape = record_wire_tape(sequence, options);
  result.scans = sequence.scans.size();
  result.ticks = tape.ticks.size();
  result.scans_per_tick = tape.scans_per_tick;
  result.publish_share = tape.publish_share;

  Replica origin(kLayer, kDefaultResolution);
  Replica copy(kLayer, kDefaultResolution);
  const auto live = run_live(tape, options, origin, copy);
  if (!live) return not_equal("exact codes");
  result.live = *live;
  const MapCounts known = counts_of(origin);
  result.voxels_known = known.free + known.occupied;
  result.blocks = known.blocks;
  result.memory_origin = bytes_per(origin, result.voxels_known);
  result.memory_copy = bytes_per(copy, result.voxels_known);

  const auto rules = run_with_rules(tape, options, origin);
  if (!rules) return not_equal("sender rules");
  result.rules = *rules;
  if (!measure_snapshot(origin, options, result)) return not_equal("snapshot");
  const auto catch_ups = bench_catch_up(tape, origin, options);
  if (!catch_ups) return not_equal("catch-up");
  result.catch_ups = *catch_ups;
  const auto query = bench_query(origin, options.map.resolution_m);
  if (!query) {
    return tl::make_unexpected(std::string("queries: the merge-map is not what OctoMap holds"));
  }
  result.query = *query;
  if (options.growth_copies > 1) result.growth = bench_growth(sequence, options);
  return result;
}

}  // namespace warren
