// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/node.hpp"

#include <algorithm>
#include <utility>

#include "transport/visitor.hpp"

namespace warren::mesh {
namespace {

// While nobody is in reach: beacons are so short and few that any figure does.
constexpr double kUnknownPace = 125'000.0;

}  // namespace

Node::Node(const EndpointConfig& node_config, std::shared_ptr<const KeySchedule> key_schedule,
           MapSource& map_source)
    : config(node_config),
      keys(std::move(key_schedule)),
      source(map_source),
      // Two lives with the same seed must not draw the same numbers of streams.
      jitter(Jitter(node_config.random_seed ^ node_config.boot.bits).bits()),
      sent_budget(node_config.parcels_bytes_max / 2),
      received_budget(node_config.parcels_bytes_max / 2),
      members(node_config.members_max) {
  for (const InterfaceConfig& interface : config.interfaces) {
    pacers.emplace_back(interface.ceiling_bit_s);
    group_rates.emplace_back();
  }
}

Peer* Node::forgettable(MeshTime now) {
  Peer* oldest = nullptr;
  MeshTime oldest_heard = now - kForgetAfter;
  for (const auto& [id, peer] : members) {
    const MeshTime heard = std::max(peer->liveness.heard(), started.value_or(now));
    if (heard >= oldest_heard || peer->liveness.up() || peer->holds_parcels()) continue;
    oldest = peer.get();
    oldest_heard = heard;
  }
  return oldest;
}

void Node::forget(MeshTime now, Peer& peer) {
  if (peer.session) {
    free_pair_number = std::max(free_pair_number, peer.session->keys.next_number());
    settle(now, peer, peer.session->flow.abandon());
  }
  fresh_from = free_pair_number;
  free_urgent_number = std::max(free_urgent_number, peer.outbox.next_urgent());
  on_forget(peer);
  for (NodePacer& pacer : pacers) pacer.forget(peer.id.number);
  events.emplace_back(MemberForgotten{peer.id});
  ++counts.members_forgotten;
  counts.outbox += peer.outbox.counts();
  counts.inbox += peer.inbox.counts();
  members.remove(peer.id);
}

bool Node::has_room_for(MeshTime now, MemberId id) {
  return !members.full() || members.find(id) != nullptr || forgettable(now) != nullptr;
}

Peer* Node::find_or_add(MeshTime now, MemberId id) {
  if (Peer* known = members.find(id)) return known;
  if (members.full()) {
    Peer* oldest = forgettable(now);
    if (oldest == nullptr) {
      count(Unused::kMemberTableFull);
      return nullptr;
    }
    forget(now, *oldest);
  }
  const DeliveryConfig delivery;
  auto peer = std::make_unique<Peer>(id, delivery, jitter.bits(), free_urgent_number, board,
                                     sent_budget, received_budget, config.interfaces.size());
  return &members.add(std::move(peer));
}

void Node::begin_session(MeshTime now, Peer& peer, BootId boot) {
  if (peer.session) {
    free_pair_number = std::max(free_pair_number, peer.session->keys.next_number());
    settle(now, peer, peer.session->flow.abandon());
    peer.outbox.on_peer_restarted();
    peer.inbox.on_peer_restarted();
    peer.scheduler.wake();
    peer.paths.reset();
    peer.answer.reset();
    peer.repeat.reset();
    events.emplace_back(MemberRestarted{peer.id});
  }
  RateController::Config rate;
  rate.packet_bytes_max = 0;
  for (const InterfaceConfig& interface : config.interfaces) {
    rate.packet_bytes_max = std::max(rate.packet_bytes_max, interface.mtu_bytes);
  }
  Session session{SessionKeys(*keys, config.boot, boot, free_pair_number), Flow(rate)};
  session.since = now;
  members.begin_session(peer, std::move(session));
}

void Node::settle(MeshTime now, Peer& peer, const Flow::Outcome& outcome) {
  for (const Ticket& ticket : outcome.acked) {
    if (const auto* map = std::get_if<MapTicket>(&ticket)) {
      source.on_acknowledged(peer.id, map->number);
    } else {
      peer.outbox.on_acked(now, ticket);
    }
  }
  for (const Ticket& ticket : outcome.lost) {
    std::visit(Visitor{[&](const MapTicket& map) {
                         source.on_lost(peer.id, map.number);
                         peer.scheduler.wake();
                       },
                       [&](const ParcelStateTicket&) { peer.inbox.on_lost(ticket); },
                       [&](const auto&) { peer.outbox.on_lost(now, ticket); }},
               ticket);
  }
}

void Node::note_liveness(MeshTime now, Peer& peer) {
  const auto changed = peer.liveness.update(now);
  if (!changed) return;
  if (*changed) {
    events.emplace_back(MemberUp{peer.id});
    somebody_came_up = true;
  } else {
    events.emplace_back(MemberDown{peer.id});
  }
}

void Node::note_moved(MeshTime now, Peer& peer) {
  peer.session->flow.on_path_changed(now);
  peer.session->sizes = {};
  events.emplace_back(MemberMoved{peer.id, *peer.paths.current()});
}

void Node::count_sent(std::size_t ip_bytes) {
  ++counts.packets_out;
  counts.ip_bytes_out += ip_bytes;
}

Node::Paces Node::paces(MeshTime now, InterfaceIndex interface) const {
  std::optional<Paces> paces;
  for (const auto& [id, peer] : members) {
    if (!peer->in_reach(now) || peer->paths.current()->interface != interface) continue;
    const double pace = peer->session->flow.pace();
    if (!paces) paces = Paces{pace, pace};
    paces->slowest = std::min(paces->slowest, pace);
    paces->fastest = std::max(paces->fastest, pace);
  }
  return paces.value_or(Paces{kUnknownPace, kUnknownPace});
}

}  // namespace warren::mesh
