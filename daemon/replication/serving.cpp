// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/serving.hpp"

#include <utility>
#include <vector>

namespace warren::replication {
namespace {

// The slots in the order of their turn: after the last one served, around; own layers first if so
// wanted.
std::vector<Slot> turns(const Peer& peer, const LayerBook& book, std::optional<Slot> last,
                        bool own_first) {
  std::vector<Slot> own;
  std::vector<Slot> order;
  const auto add = [&](Slot slot) {
    const bool goes_first = own_first && book.layers()[slot]->own != nullptr;
    (goes_first ? own : order).push_back(slot);
  };
  const auto begin = last ? peer.subscriptions.upper_bound(*last) : peer.subscriptions.begin();
  for (auto next = begin; next != peer.subscriptions.end(); ++next) add(next->first);
  for (auto next = peer.subscriptions.begin(); next != begin; ++next) add(next->first);
  own.insert(own.end(), order.begin(), order.end());
  return own;
}

}  // namespace

void Serving::on_wish(Peer& from, const Wish& wish) {
  const HeldLayer* const layer = node_.book.at(wish.slot);
  if (layer == nullptr || !from.subscriptions[wish.slot].on_wish(wish, layer->replica())) {
    ++node_.refused.stale_wishes;
    return;
  }
  if (!wish.wanted) return;
  node_.commands.emplace_back(Wake{from.id});
  group_.wake(from.interface);
}

void Serving::on_news(const HeldLayer& layer) {
  if (!layer.may_be_told()) return;
  for (const auto& [id, peer] : node_.peers) {
    const auto subscription = peer.subscriptions.find(layer.slot);
    if (subscription == peer.subscriptions.end() || !subscription->second.wanted()) continue;
    if (!peer.up) continue;
    node_.commands.emplace_back(Wake{id});
    group_.wake(peer.interface);
  }
}

void Serving::on_up(Peer& peer) {
  for (auto& [slot, subscription] : peer.subscriptions) {
    subscription.raise_goal(node_.book.at(slot)->replica());
  }
  node_.commands.emplace_back(Wake{peer.id});
}

std::optional<DiffPacket> Serving::next_of(Peer& to, Slot slot, mesh::MapClass wanted,
                                           std::size_t limit) {
  const HeldLayer& layer = *node_.book.at(slot);
  if (!layer.may_be_told()) return std::nullopt;
  Subscription& subscription = to.subscriptions.at(slot);
  if (wanted == mesh::MapClass::kBacklog) return subscription.next_backlog(layer.replica(), limit);
  if (group_.serves(to, slot)) return std::nullopt;
  return subscription.next_fresh(layer.replica(), limit);
}

std::optional<mesh::MapSource::Packet> Serving::next_for(Peer& to, mesh::MapClass wanted,
                                                         std::size_t limit) {
  if (limit <= kDiffOverhead) return std::nullopt;
  const bool fresh = wanted == mesh::MapClass::kFresh;
  auto& last = fresh ? to.last_fresh : to.last_backlog;
  for (const Slot slot : turns(to, node_.book, last, fresh)) {
    const auto packet = next_of(to, slot, wanted, limit - kDiffOverhead);
    if (!packet) continue;
    last = slot;
    const std::uint64_t ticket = node_.next_ticket++;
    to.subscriptions.at(slot).on_sent(ticket, packet->claim);
    to.sent[ticket] = DiffSent{slot};
    auto bytes = encode(DiffMessage{slot, packet->bytes});
    (fresh ? to.traffic_out.fresh_bytes : to.traffic_out.backlog_bytes) += bytes.size();
    return mesh::MapSource::Packet{ticket, wanted, std::move(bytes)};
  }
  return std::nullopt;
}

void Serving::on_acknowledged(Peer& peer, Slot slot, std::uint64_t ticket) {
  const auto found = peer.subscriptions.find(slot);
  if (found == peer.subscriptions.end()) return;
  found->second.on_acknowledged(ticket);
  // The acknowledged keys may be swept now, and what came after lacks them.
  if (found->second.wanted()) node_.commands.emplace_back(Wake{peer.id});
}

void Serving::on_lost(Peer& peer, Slot slot, std::uint64_t ticket) {
  const auto found = peer.subscriptions.find(slot);
  if (found != peer.subscriptions.end()) found->second.on_lost(ticket);
}

}  // namespace warren::replication
