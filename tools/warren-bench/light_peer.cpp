// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/light_peer.hpp"

#include <utility>
#include <vector>

#include "daemon/random_bits.hpp"

namespace warren {
namespace {

constexpr std::uint64_t kHeaderBytes = 28;  // IPv4 and UDP

}  // namespace

LightPeer::LightPeer(asio::io_context& io, const FleetConfig& config, TapePlay play)
    : store_(io),
      play_(std::move(play)),
      map_(config.map, random_bits),
      mesh_(io, config.mesh, map_, store_) {
  map_.on_open([this](const OwnLayer& layer) { mesh_.on_opened(layer); });
}

void LightPeer::tick() {
  FleetTape::Tick tick = play_.next();
  LayerChanges changes{0, {}, {}, {0.0, 0.0, -1.0}, std::move(tick.blocks), tick.position_layer};
  map_.tick({&changes, 1});
  mesh_.on_ticked({});
}

void LightPeer::flush() {
  map_.flush();
  mesh_.on_ticked({});
}

LightPeer::Progress LightPeer::progress() {
  Progress progress;
  for (const FleetNodeReport& node : mesh_.report().nodes) {
    progress.neighbours_up += node.neighbour && node.neighbour->up;
  }
  for (const replication::LayerReport& layer : mesh_.replication_report()) {
    if (!layer.own) continue;
    for (const replication::PeerLag& peer : layer.peers) {
      const bool has_all = peer.lag_revisions == 0;
      progress.have_all += has_all;
      progress.digests_equal += has_all && peer.digest_equal == true;
    }
  }
  return progress;
}

std::uint64_t LightPeer::voxels_published() const {
  std::uint64_t voxels = 0;
  for (const auto& [number, own] : map_.own_layers()) voxels += own.layer().known_voxels();
  return voxels;
}

std::uint64_t LightPeer::bytes_sent() {
  std::uint64_t bytes = 0;
  for (const FleetInterfaceReport& interface : mesh_.report().interfaces) {
    bytes += interface.counts.bytes_sent + kHeaderBytes * interface.counts.sent;
  }
  return bytes;
}

}  // namespace warren
