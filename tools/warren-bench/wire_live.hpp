// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/layer/replica.hpp"
#include "tools/warren-bench/wire_tape.hpp"

namespace warren {

struct WireTraffic {
  std::uint64_t bytes = 0;
  std::uint64_t packets = 0;
};

// One pass of a tape's exact codes over the wire, tick by tick, and the same diff-maps in the
// rivals' hands. CPU of one thread, milliseconds in all.
struct LiveResult {
  std::uint64_t voxels_changed = 0;
  WireTraffic ours;
  std::uint64_t octree7_flown_bytes = 0;
  std::uint64_t octree7_pruned_bytes = 0;
  std::uint64_t tree_bytes = 0;
  std::uint64_t tree_zstd_bytes = 0;
  double encode_ms = 0.0;
  double zstd_ms = 0.0;  // of compressing alone
  double apply_ms = 0.0;
  double octomap_ms = 0.0;  // of the faster of its two modes
};

// `origin` and `copy` are empty at first, and equal in the end. Nothing if a packet was not taken
// or they are not.
std::optional<LiveResult> run_live(const WireTape& tape, const WireOptions& options,
                                   Replica& origin, Replica& copy);

struct RulesResult {
  WireTraffic live;
  WireTraffic flush;  // of what was held back to the end
};
// The same with the sender rules. Nothing if a packet was not taken, or if the flushed copy is not
// `exact`.
std::optional<RulesResult> run_with_rules(const WireTape& tape, const WireOptions& options,
                                          const Replica& exact);

}  // namespace warren
