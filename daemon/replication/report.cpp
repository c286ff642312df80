// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/report.hpp"

#include <bit>

#include "daemon/replication/holdings_walk.hpp"

namespace warren::replication {
namespace {

std::uint64_t voxels_changed(const Replica& layer, Revision from) {
  std::uint64_t voxels = 0;
  layer.for_each_changed({}, from, [&](BlockOrdinal, const LayerBlock& block) {
    for (const std::uint64_t cell : block.history.changed_since(from)) {
      voxels += static_cast<std::uint64_t>(std::popcount(cell));
    }
    return true;
  });
  return voxels;
}

std::optional<bool> digest_equal(const HeldLayer& layer, const Announcement* said) {
  if (said == nullptr || !said->digest) return std::nullopt;
  if (said->holdings != layer.replica().holdings()) return std::nullopt;
  return *said->digest == prefix_of(layer.replica().digest().root());
}

PeerLag lag_of(const NodeState& node, const HeldLayer& layer, const Peer& peer) {
  const Announcement* const said = peer.find(layer.id);
  const auto subscription = peer.subscriptions.find(layer.slot);
  Holdings held = said == nullptr ? Holdings() : said->holdings;
  if (subscription != peer.subscriptions.end()) {
    held = higher_of(held, subscription->second.believed());
  }
  PeerLag lag;
  lag.member = peer.id;
  lag.has_all_up_to = held.lowest({});
  lag.digest_equal = digest_equal(layer, said);
  const Revision ours = layer.highest();
  if (lag.has_all_up_to >= ours) return lag;
  lag.lag_revisions = ours.number - lag.has_all_up_to.number;
  lag.lag_voxels = voxels_changed(layer.replica(), lag.has_all_up_to);
  if (const auto since = layer.times.since(lag.has_all_up_to)) lag.behind = node.now - *since;
  return lag;
}

}  // namespace

std::vector<LayerReport> report(const NodeState& node, const Pulling& pulling,
                                const DigestWalk& walk) {
  std::vector<LayerReport> reports;
  for (const auto& layer : node.book.layers()) {
    LayerReport line;
    line.id = layer->id;
    line.own = layer->own != nullptr;
    line.has_all_up_to = layer->replica().holdings().lowest({});
    line.highest = layer->highest();
    line.full = layer->full;
    line.digests = walk.counts_of(layer->slot);
    if (line.own) line.hops = 0;
    if (const Pull* const pull = line.own ? nullptr : pulling.find(*layer)) {
      line.provider = pull->provider;
      line.hops = pull->hops;
    }
    for (const auto& [id, peer] : node.peers) {
      const bool known =
          peer.find(layer->id) != nullptr || peer.subscriptions.contains(layer->slot);
      if (known) line.peers.push_back(lag_of(node, *layer, peer));
    }
    reports.push_back(std::move(line));
  }
  return reports;
}

}  // namespace warren::replication
