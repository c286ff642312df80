// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/wire_live.hpp"

#include <algorithm>

#include "core/layer/publisher.hpp"
#include "tools/rivals/octree7.hpp"
#include "tools/rivals/tree_zstd.hpp"
#include "tools/warren-bench/octomap_codes_peer.hpp"
#include "tools/warren-bench/stopwatch.hpp"
#include "tools/warren-bench/wire_sweep.hpp"

namespace warren {
namespace {

// The rivals' side of a pass.
class Rivals {
 public:
  explicit Rivals(double resolution_m) : eager_(resolution_m, false), lazy_(resolution_m, true) {}

  void take(const std::vector<ChangedVoxel>& changed, LiveResult& result) {
    result.octree7_flown_bytes += encode_octree7(changed, Pruning::kNone).size();
    result.octree7_pruned_bytes += encode_octree7(changed, Pruning::kEqualCodes).size();
    const auto tree = encode_tree(changed);
    result.tree_bytes += tree.size();
    result.tree_zstd_bytes += zstd_watch_.time([&] { return compress_zstd(tree); }).size();
    eager_watch_.time([&] { eager_.insert(changed); });
    lazy_watch_.time([&] { lazy_.insert(changed); });
  }

  void finish(LiveResult& result) {
    lazy_watch_.time([&] { lazy_.finish(); });
    result.zstd_ms = zstd_watch_.ms_per(1);
    result.octomap_ms = std::min(eager_watch_.ms_per(1), lazy_watch_.ms_per(1));
  }

 private:
  OctomapCodesPeer eager_;
  OctomapCodesPeer lazy_;
  Stopwatch zstd_watch_;
  Stopwatch eager_watch_;
  Stopwatch lazy_watch_;
};

void count(WireTraffic& traffic, const std::vector<DiffPacket>& packets) {
  traffic.bytes += bytes_of(packets);
  traffic.packets += packets.size();
}

}  // namespace

std::optional<LiveResult> run_live(const WireTape& tape, const WireOptions& options,
                                   Replica& origin, Replica& copy) {
  LiveResult result;
  Rivals rivals(options.map.resolution_m);
  Stopwatch encoding;
  Stopwatch applying;
  for (const auto& tick : tape.ticks) {
    const auto changed = changed_voxels(tick, origin);
    result.voxels_changed += changed.size();
    const Revision from = origin.holdings().at(0);
    origin.publish(tick);
    const auto packets = encoding.time([&] { return sweep(origin, from, options.packet_bytes); });
    if (!applying.time([&] { return apply_all(copy, packets); })) return std::nullopt;
    count(result.ours, packets);
    rivals.take(changed, result);
  }
  rivals.finish(result);
  result.encode_ms = encoding.ms_per(1);
  result.apply_ms = applying.ms_per(1);
  if (!same_blocks(origin, copy)) return std::nullopt;
  return result;
}

std::optional<RulesResult> run_with_rules(const WireTape& tape, const WireOptions& options,
                                          const Replica& exact) {
  RulesResult result;
  Publisher publisher;
  Replica origin(exact.id(), exact.resolution());
  Replica copy(exact.id(), exact.resolution());
  const auto publish = [&](const std::vector<CodedBlock>& blocks, WireTraffic& traffic) {
    const Revision from = origin.holdings().at(0);
    origin.publish(blocks);
    const auto packets = sweep(origin, from, options.packet_bytes);
    count(traffic, packets);
    return apply_all(copy, packets);
  };
  for (const auto& tick : tape.ticks) {
    if (!publish(publisher.tick(tick, origin), result.live)) return std::nullopt;
  }
  if (!publish(publisher.flush(origin), result.flush)) return std::nullopt;
  if (!same_blocks(exact, copy)) return std::nullopt;
  return result;
}

}  // namespace warren
