// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/warren-bench/machine.hpp"
#include "tools/warren-bench/wire_bench.hpp"

namespace warren {
namespace {

using Json = nlohmann::ordered_json;

double over(double theirs, double ours) { return ours > 0.0 ? theirs / ours : 0.0; }

struct Ratios {
  double octree7_flown;
  double octree7_pruned;
  double tree_zstd;
  double encode_zstd;
  double decode_octomap;

  explicit Ratios(const LiveResult& live)
      : octree7_flown(by_bytes(live.octree7_flown_bytes, live)),
        octree7_pruned(by_bytes(live.octree7_pruned_bytes, live)),
        tree_zstd(by_bytes(live.tree_zstd_bytes, live)),
        encode_zstd(over(live.zstd_ms, live.encode_ms)),
        decode_octomap(over(live.octomap_ms, live.apply_ms)) {}

 private:
  static double by_bytes(std::uint64_t theirs, const LiveResult& live) {
    return over(static_cast<double>(theirs), static_cast<double>(live.ours.bytes));
  }
};

Json catch_ups_json(const WireResult& r) {
  Json all = Json::array();
  for (const CatchUp& one : r.catch_ups) {
    all.push_back({{"missed_share", one.missed_share},
                   {"snapshot_bytes", one.snapshot_bytes},
                   {"ratio", one.ratio()},
                   {"ratio_key_order", one.key_order_ratio()},
                   {"relay_ratio", one.relay_ratio()},
                   {"relay_ratio_key_order", one.relay_key_order_ratio()}});
  }
  return all;
}

Json growth_json(const WireResult& r) {
  if (!r.growth) return nullptr;
  return {{"publish_share", r.growth->publish_share}, {"apply_share", r.growth->apply_share}};
}

Json head_json(const WireResult& r, const WireOptions& options, std::optional<double> max_range_m) {
  const Machine machine = this_machine();
  return {{"benchmark", "wire"},
          {"machine",
           {{"cpu", machine.cpu}, {"cpu_level", machine.cpu_level}, {"build", machine.build}}},
          {"resolution_m", options.map.resolution_m},
          {"max_range_m", max_range_m ? Json(*max_range_m) : nullptr},
          {"tick_s", options.tick_s},
          {"packet_bytes", options.packet_bytes},
          {"scans", r.scans},
          {"scans_per_tick", r.scans_per_tick},
          {"ticks", r.ticks},
          {"packets", r.live.ours.packets},
          {"voxels_changed", r.live.voxels_changed},
          {"voxels_known", r.voxels_known},
          {"blocks", r.blocks}};
}

Json bits_json(const WireResult& r) {
  const std::uint64_t rules = r.rules.live.bytes;
  return {
      {"bits_per_changed_voxel", r.per_changed_voxel(r.live.ours.bytes)},
      {"bits_per_changed_voxel_rules", r.per_changed_voxel(rules)},
      {"bits_per_changed_voxel_rules_flushed", r.per_changed_voxel(rules + r.rules.flush.bytes)},
      {"bits_per_known_voxel_snapshot", r.per_known_voxel(r.snapshot.bytes)},
      {"bits_per_changed_voxel_octree7_flown", r.per_changed_voxel(r.live.octree7_flown_bytes)},
      {"bits_per_changed_voxel_octree7_pruned", r.per_changed_voxel(r.live.octree7_pruned_bytes)},
      {"bits_per_changed_voxel_tree", r.per_changed_voxel(r.live.tree_bytes)},
      {"bits_per_changed_voxel_tree_zstd", r.per_changed_voxel(r.live.tree_zstd_bytes)}};
}

Json cost_json(const WireResult& r) {
  const Ratios ratios(r.live);
  return {{"ratio_octree7_flown", ratios.octree7_flown},
          {"ratio_octree7_pruned", ratios.octree7_pruned},
          {"ratio_tree_zstd", ratios.tree_zstd},
          {"catchup_ratio_max", r.catchup_ratio_max()},
          {"catchup_relay_ratio_max", r.catchup_relay_ratio_max()},
          {"catch_ups", catch_ups_json(r)},
          {"ratio_encode_zstd", ratios.encode_zstd},
          {"ratio_decode_octomap", ratios.decode_octomap},
          {"encode_cpu_ms", r.live.encode_ms},
          {"zstd_cpu_ms", r.live.zstd_ms},
          {"apply_cpu_ms", r.live.apply_ms},
          {"octomap_cpu_ms", r.live.octomap_ms},
          {"publish_share", r.publish_share},
          {"ratio_query_octomap", over(r.query.octomap_ns, r.query.ours_ns)},
          {"query_cpu_ns", r.query.ours_ns},
          {"octomap_query_cpu_ns", r.query.octomap_ns},
          {"query_known_share", r.query.known_share},
          {"growth", growth_json(r)},
          {"memory_bytes_per_known_voxel",
           {{"origin", r.memory_origin},
            {"copy", r.memory_copy},
            {"copy_fed_in_bulk", r.memory_bulk_copy}}}};
}

}  // namespace

std::string to_text(const WireResult& r) {
  const Machine machine = this_machine();
  const auto line = [](const std::string& what, double figure) {
    return fmt::format("{:<48}{:>12.3f}\n", what, figure);
  };
  std::string text = fmt::format("{} ({}), {}\n", machine.cpu, machine.cpu_level, machine.build);
  text += fmt::format("{} scans, {} a tick; {} voxels changed, {} known in {} blocks\n", r.scans,
                      r.scans_per_tick, r.live.voxels_changed, r.voxels_known, r.blocks);
  for (const Json& part : {bits_json(r), cost_json(r)}) {
    for (const auto& entry : part.items()) {
      if (entry.value().is_number()) text += line(entry.key(), entry.value().get<double>());
    }
  }
  for (const CatchUp& one : r.catch_ups) {
    const std::string missed =
        fmt::format("{:.0f} % missed, of a snapshot", 100 * one.missed_share);
    text += line(missed, one.ratio()) + line(missed + ", by a relay", one.relay_ratio());
    text += line(missed + ", key order", one.key_order_ratio());
  }
  text += line("memory_bytes_per_known_voxel, origin", r.memory_origin);
  text += line("memory_bytes_per_known_voxel, copy", r.memory_copy);
  text += line("memory_bytes_per_known_voxel, fed in bulk", r.memory_bulk_copy);
  if (r.growth) {
    text += line("publish, in the grown map over alone", r.growth->publish_share);
    text += line("apply, in the grown map over alone", r.growth->apply_share);
  }
  return text;
}

std::string to_json(const WireResult& result, const WireOptions& options,
                    std::optional<double> max_range_m) {
  Json json = head_json(result, options, max_range_m);
  json.update(bits_json(result));
  json.update(cost_json(result));
  return json.dump(2);
}

}  // namespace warren
