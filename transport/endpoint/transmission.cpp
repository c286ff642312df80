// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/transmission.hpp"

#include <algorithm>

#include "transport/endpoint/packet_builder.hpp"

namespace warren::mesh {
namespace {

// What is due and cannot be helped now is looked at again after this.
constexpr Duration kLookAgain = std::chrono::milliseconds(25);

}  // namespace

Transmission::Transmission(Node& node)
    : node_(node),
      group_key_(node.keys->group_key(node.config.boot)),
      turns_wanted_(node.config.interfaces.size()),
      group_awake_(node.config.interfaces.size()),
      group_alone_(node.config.interfaces.size()) {
  for (std::size_t i = 0; i < group_awake_.size(); ++i) {
    if (node.config.interfaces[i].group_broadcast) wake_group(static_cast<InterfaceIndex>(i));
  }
}

void Transmission::set_deadline(Peer& peer, MeshTime deadline) {
  if (peer.deadline == deadline) return;
  if (peer.deadline != kNever) deadlines_.erase({peer.deadline, peer.id});
  peer.deadline = deadline;
  if (deadline != kNever) deadlines_.emplace(deadline, peer.id);
}

void Transmission::set_prompt(Peer& peer, bool prompt) {
  if (peer.prompt == prompt) return;
  peer.prompt = prompt;
  if (prompt) {
    prompt_.insert(peer.id);
  } else {
    prompt_.erase(peer.id);
  }
}

void Transmission::set_turn(Peer& peer, std::optional<InterfaceIndex> interface) {
  if (peer.in_turn == interface) return;
  if (peer.in_turn) {
    node_.pacers[*peer.in_turn].want(peer.id.number, false);
    --turns_wanted_[*peer.in_turn];
  }
  peer.in_turn = interface;
  if (interface) {
    node_.pacers[*interface].want(peer.id.number, true);
    ++turns_wanted_[*interface];
  }
}

void Transmission::forget(Peer& peer) {
  set_deadline(peer, kNever);
  set_prompt(peer, false);
  set_turn(peer, std::nullopt);
}

void Transmission::wake_group(InterfaceIndex interface) {
  if (!node_.config.interfaces[interface].group_broadcast || group_awake_[interface]) return;
  group_awake_[interface] = true;
  group_alone_[interface] = false;
  node_.pacers[interface].want(NodePacer::kGroup, true);
  ++turns_wanted_[interface];
}

bool Transmission::wants_turn(MeshTime now, Peer& peer, MeshTime due) {
  Flow& flow = peer.session->flow;
  if (!flow.may_send(now)) return false;
  if (peer.repeat || due <= now) return true;
  const PacketSize& size = peer.paths.size();
  if (size.wants_large_probe(now) || size.wants_small_probe()) return true;
  peer.repeat = flow.take_repeat(now);
  return peer.repeat.has_value();
}

MeshTime Transmission::deadline_of(MeshTime now, const Peer& peer, MeshTime due, bool serviced) {
  MeshTime deadline = peer.liveness.next();
  if (peer.answer) deadline = std::min(deadline, peer.answer->at);
  if (!peer.session) return deadline;
  // What its flow wanted in the past has been done, or cannot be done now.
  const MeshTime flow = peer.session->flow.next_time();
  deadline = std::min(deadline, serviced && flow <= now ? now + kLookAgain : flow);
  if (!peer.in_reach(now)) return deadline;
  deadline = std::min(deadline, peer.outbox.next_due(SendClass::kUrgent));
  return due > now ? std::min(deadline, due) : deadline;
}

void Transmission::refresh(MeshTime now, Peer& peer, bool serviced) {
  const bool in_reach = peer.in_reach(now);
  const bool answers = peer.session && peer.answer && peer.answer->at <= now;
  set_prompt(peer, answers || (in_reach && (peer.session->flow.ack_due(now) ||
                                            peer.outbox.next_due(SendClass::kUrgent) <= now)));
  if (in_reach && group_alone_[peer.paths.current()->interface]) {
    wake_group(peer.paths.current()->interface);
  }
  // When its classes have something to send, its turn aside.
  const MeshTime due =
      in_reach ? peer.scheduler.next_due(send_state(node_, now, peer), peer.outbox, peer.inbox)
               : kNever;
  if (in_reach && wants_turn(now, peer, due)) {
    set_turn(peer, peer.paths.current()->interface);
  } else {
    set_turn(peer, std::nullopt);
  }
  set_deadline(peer, deadline_of(now, peer, due, serviced));
}

void Transmission::service(MeshTime now, Peer& peer) {
  if (peer.session) {
    node_.settle(now, peer, peer.session->flow.on_time(now));
    const LinkQuality quality = peer.session->flow.quality();
    peer.paths.note_quality(quality.loss_out, quality.rtt.value_or(Duration{}));
    if (peer.paths.current()) {
      peer.session->sizes.on_time(now, quality.rtt.value_or(Duration{}), peer.paths.size());
    }
    if (peer.paths.choose(now)) node_.note_moved(now, peer);
  }
  node_.note_liveness(now, peer);
  refresh(now, peer, true);
  if (peer.deadline <= now) set_deadline(peer, now + kLookAgain);
}

std::optional<Datagram> Transmission::poll(MeshTime now) {
  while (!deadlines_.empty() && deadlines_.begin()->first <= now) {
    service(now, *node_.members.find(deadlines_.begin()->second));
  }
  if (auto datagram = poll_prompt(now)) return datagram;
  for (std::size_t i = 0; i < node_.pacers.size(); ++i) {
    if (auto datagram = poll_turn(now, static_cast<InterfaceIndex>(i))) return datagram;
  }
  return std::nullopt;
}

std::optional<Datagram> Transmission::poll_prompt(MeshTime now) {
  while (!prompt_.empty()) {
    Peer& peer = *node_.members.find(*prompt_.begin());
    // An answer to someone not in reach yet brings what waits for him along, one packet.
    const bool everything =
        peer.session->flow.may_send(now) && (peer.answer || peer.in_turn) &&
        (!peer.liveness.up() || (peer.in_turn && node_.pacers[*peer.in_turn].ready_at() <= now));
    auto datagram = build_packet(node_, now, peer,
                                 everything ? PacketFill::kEverything : PacketFill::kUrgentOnly);
    refresh(now, peer);
    if (datagram) return datagram;
    // What is due cannot go now.
    set_prompt(peer, false);
    if (peer.deadline <= now) set_deadline(peer, now + kLookAgain);
  }
  return std::nullopt;
}

std::optional<Datagram> Transmission::poll_turn(MeshTime now, InterfaceIndex interface) {
  NodePacer& pacer = node_.pacers[interface];
  while (const auto turn = pacer.next(now)) {
    if (*turn == NodePacer::kGroup) {
      if (auto datagram = group_packet(now, interface)) return datagram;
      continue;
    }
    Peer& peer = *node_.members.find(MemberId{*turn});
    // Things may have changed since it asked for the turn.
    if (!peer.in_reach(now) || !peer.session->flow.may_send(now)) {
      refresh(now, peer);
      continue;
    }
    auto datagram = build_packet(node_, now, peer, PacketFill::kEverything);
    refresh(now, peer);
    if (datagram) return datagram;
    set_turn(peer, std::nullopt);
    if (peer.deadline <= now) set_deadline(peer, now + kLookAgain);
  }
  return std::nullopt;
}

std::optional<Datagram> Transmission::group_packet(MeshTime now, InterfaceIndex interface) {
  const InterfaceConfig& config = node_.config.interfaces[interface];
  const bool heard = std::any_of(node_.members.begin(), node_.members.end(), [&](const auto& m) {
    return m.second->in_reach(now) && m.second->paths.current()->interface == interface;
  });
  const std::size_t limit =
      config.mtu_bytes - config.ip_header_bytes - kEnvelopeBytes - MapFrame::kOverhead;
  const bool fits = limit >= node_.source.bytes_min();
  auto packet = heard && fits ? node_.source.next_for_group(interface, limit) : std::nullopt;
  if (!packet) {
    group_alone_[interface] = !heard;
    group_awake_[interface] = false;
    node_.pacers[interface].want(NodePacer::kGroup, false);
    --turns_wanted_[interface];
    return std::nullopt;
  }
  std::vector<std::uint8_t> content;
  append(content, MapFrame{packet->priority, std::move(packet->bytes)});
  Datagram datagram{
      {interface, true, {}},
      seal(group_key_, {PacketType::kGroup, node_.config.boot, group_number_++}, content)};
  const std::size_t ip_bytes = node_.link_bytes(datagram);
  const double pace = node_.group_rates[interface].pace(node_.paces(now, interface).slowest);
  node_.pacers[interface].on_sent(now, NodePacer::kGroup, ip_bytes, pace);
  node_.count_sent(ip_bytes);
  ++node_.counts[SentClass::kGroup].packets;
  node_.counts[SentClass::kGroup].bytes += content.size();
  return datagram;
}

MeshTime Transmission::next(MeshTime now) const {
  if (!prompt_.empty()) return now;
  MeshTime next = deadlines_.empty() ? kNever : deadlines_.begin()->first;
  for (std::size_t i = 0; i < turns_wanted_.size(); ++i) {
    if (turns_wanted_[i] > 0) next = std::min(next, node_.pacers[i].ready_at());
  }
  return next;
}

}  // namespace warren::mesh
