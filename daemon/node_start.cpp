// SPDX-License-Identifier: Apache-2.0
#include "daemon/node_start.hpp"

#include <cstdio>
#include <utility>

#include "daemon/log.hpp"

namespace warren {
namespace {

std::string in_seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", seconds);
  return text;
}

void log_start(const std::string& file, const StartReport& report) {
  if (report.moved_aside) {
    log_error("store: damaged (" + report.moved_aside->why + "): moved to " +
              report.moved_aside->to.string() + "; this node begins anew");
  }
  if (report.rolled_back) {
    log_error("store: " + std::to_string(report.commits_lost) +
              " commits are lost that others may have heard of: a new map layer is begun");
  }
  if (report.fresh) return log_info("store: " + file + " is new");
  if (report.recovered) log_info("store: the life before ended suddenly; its log was read");
  log_info("store: " + std::to_string(report.layers) + " layers, " + std::to_string(report.items) +
           " messages, " + std::to_string(report.blocks) + " blocks in " + file +
           ", all checked in " + in_seconds(report.seconds));
}

void log_node(const StoredNode& node) {
  std::uint64_t scans = 0;
  for (const auto& [head, voxels] : node.map.layers) scans += head.scans;
  if (!node.map.layers.empty()) {
    log_info("store: the map goes on after " + std::to_string(scans) + " scans in " +
             std::to_string(node.map.layers.size()) + " layers");
  }
  if (node.layers_ended > 0) {
    log_warning("store: " + std::to_string(node.layers_ended) +
                " layers of this node are kept and shared, but not continued: revisions of them "
                "are lost, or the map's config has changed");
  }
  if (node.items_refused > 0) {
    log_error("store: " + std::to_string(node.items_refused) + " messages make no sense");
  }
}

}  // namespace

tl::expected<NodeStart, std::string> start_node(const Config& config) {
  NodeStart start;
  if (!config.store.enabled) return start;
  StoreConfig store;
  store.file = config.store.file;
  store.disk_bytes_max = config.store.disk_mb_max * kBytesPerMegabyte;
  auto opened = Store::open(store);
  if (!opened) return tl::unexpected("store: " + opened.error().text);
  log_start(store.file.string(), opened->report);
  auto node = restore_node(opened->store, opened->report, config.self_map());
  if (!node) return tl::unexpected(node.error());
  log_node(*node);
  start.map = std::move(node->map);
  start.fleet = {std::move(opened->store), std::move(node->own), std::move(node->fleet)};
  return start;
}

}  // namespace warren
