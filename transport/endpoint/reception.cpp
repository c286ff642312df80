// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/reception.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "transport/visitor.hpp"

namespace warren::mesh {
namespace {

bool wants_ack(const std::vector<Frame>& frames) {
  return std::any_of(frames.begin(), frames.end(),
                     [](const Frame& frame) { return !std::holds_alternative<AckFrame>(frame); });
}

const HelloFrame* hello_in(const std::vector<Frame>& frames) {
  for (const Frame& frame : frames) {
    if (const auto* hello = std::get_if<HelloFrame>(&frame)) return hello;
  }
  return nullptr;
}

// Only who lives now has received numbers that were not used before.
bool acknowledges_since(const std::vector<Frame>& frames, std::uint64_t first) {
  return std::any_of(frames.begin(), frames.end(), [&](const Frame& frame) {
    const auto* ack = std::get_if<AckFrame>(&frame);
    return ack != nullptr && !ack->ranges.empty() && ack->ranges.front().end > first;
  });
}

// Whoever acknowledges us, or no longer asks, has heard us.
bool shows_we_are_heard(const std::vector<Frame>& frames) {
  const HelloFrame* hello = hello_in(frames);
  if (hello != nullptr) return !hello->wants_answer;
  return std::any_of(frames.begin(), frames.end(),
                     [](const Frame& frame) { return std::holds_alternative<AckFrame>(frame); });
}

}  // namespace

Peer* Reception::on_datagram(MeshTime now, const MeshPath& sender,
                             std::span<const std::uint8_t> bytes) {
  // What is answered goes to the sender alone.
  const MeshPath from{sender.interface, false, sender.address};
  ++node_.counts.packets_in;
  node_.counts.ip_bytes_in += node_.ip_bytes(from.interface, bytes.size());
  const auto header = read_packet_header(bytes);
  if (!header) {
    node_.count(Unused::kNoPacketOfOurs);
    return nullptr;
  }
  if (header->sender == node_.config.boot) {
    node_.count(Unused::kOwnEcho);
    return nullptr;
  }
  switch (header->type) {
    case PacketType::kBeacon:
      return discovery_.on_beacon(now, *header, from, bytes);
    case PacketType::kPair:
      return on_pair_packet(now, *header, from, bytes);
    case PacketType::kGroup:
      return on_group_packet(*header, bytes);
  }
  return nullptr;
}

// From a boot without a session: authentic, it proves the boot, because whoever sealed it knows
// this life of ours.
Peer* Reception::on_first_packet(MeshTime now, const PacketHeader& header, const MeshPath& from,
                                 std::span<const std::uint8_t> packet) {
  if (node_.members.is_retired(header.sender)) {
    node_.count(Unused::kRetiredBoot);
    return nullptr;
  }
  const auto content = open(node_.keys->pair_key(header.sender, node_.config.boot), packet);
  if (!content) {
    node_.count(Unused::kNotAuthentic);
    return nullptr;
  }
  const auto frames = read_frames(*content);
  const HelloFrame* hello = frames ? hello_in(*frames) : nullptr;
  if (hello == nullptr) {
    node_.count(frames ? Unused::kUnknownSender : Unused::kMalformed);
    return nullptr;
  }
  if (!node_.can_be_peer(hello->member)) {
    node_.count(hello->member == node_.config.self ? Unused::kOwnMember : Unused::kMalformed);
    return nullptr;
  }
  if (!node_.has_room_for(now, hello->member)) {
    node_.count(Unused::kMemberTableFull);
    return nullptr;
  }
  // Perhaps recorded in a life before the one that we know, and never received; or before its
  // sender was forgotten.
  const Peer* known = node_.members.find(hello->member);
  const auto fresh_from = known != nullptr && known->session
                              ? std::optional(known->session->keys.first_number())
                              : node_.fresh_from;
  if (fresh_from && !acknowledges_since(*frames, *fresh_from)) {
    node_.count(Unused::kNotFresh);
    discovery_.challenge(now, header.sender, hello->member, from);
    return nullptr;
  }
  Peer* peer = node_.find_or_add(now, hello->member);
  node_.begin_session(now, *peer, header.sender);
  discovery_.on_confirmed(header.sender);
  return peer;
}

Peer* Reception::on_pair_packet(MeshTime now, const PacketHeader& header, const MeshPath& from,
                                std::span<const std::uint8_t> packet) {
  Peer* peer = node_.members.find(header.sender);
  if (peer == nullptr) peer = on_first_packet(now, header, from, packet);
  if (peer == nullptr) return nullptr;
  Session& session = *peer->session;
  const auto content = session.keys.open(header, packet);
  if (!content) {
    node_.count(content.error());
    return nullptr;
  }
  auto frames = read_frames(*content);
  if (!frames) {
    node_.count(Unused::kMalformed);
    return nullptr;
  }
  session.awaiting_since.reset();
  if (peer->asked != MeshTime::min() && now - peer->asked < Peer::kProofOfClock) {
    session.booted.reset();  // it lives: the next beacon is believed
    peer->asked = MeshTime::min();
  }
  session.flow.on_heard(now);
  session.flow.on_received(
      now, {header.number, node_.ip_bytes(from.interface, packet.size()), wants_ack(*frames)});
  if (peer->paths.on_pair_packet(now, from, session.keys.is_newest_pair(header))) {
    node_.note_moved(now, *peer);
  }
  peer->liveness.on_pair_packet(now);
  node_.note_liveness(now, *peer);
  if (shows_we_are_heard(*frames)) peer->answer.reset();
  for (Frame& frame : *frames) on_frame(now, *peer, from, std::move(frame));
  relieve_memory();
  return peer;
}

Peer* Reception::on_group_packet(const PacketHeader& header, std::span<const std::uint8_t> packet) {
  Peer* peer = node_.members.find(header.sender);
  if (peer == nullptr) {
    node_.count(node_.members.is_retired(header.sender) ? Unused::kRetiredBoot
                                                        : Unused::kUnknownSender);
    return nullptr;
  }
  const auto content = peer->session->keys.open(header, packet);
  if (!content) {
    node_.count(content.error());
    return nullptr;
  }
  auto frames = read_frames(*content);
  if (!frames || frames->size() != 1 || !std::holds_alternative<MapFrame>(frames->front())) {
    node_.count(Unused::kMalformed);
    return nullptr;
  }
  auto& map = std::get<MapFrame>(frames->front());
  node_.events.emplace_back(MapArrived{peer->id, map.priority, std::move(map.bytes)});
  return peer;
}

void Reception::reply(MeshTime now, Peer& peer, const MeshPath& from) {
  const bool too_soon = peer.replied != MeshTime::min() && now - peer.replied < Peer::kReplyLeast;
  if (!too_soon) peer.replied = now;
  peer.answer = Peer::Answer{too_soon ? peer.replied + Peer::kReplyLeast : now, from, false,
                             Peer::kReplyTries};
}

void Reception::on_acknowledgement(MeshTime now, Peer& peer, const AckFrame& ack) {
  const auto outcome = peer.session->flow.on_ack(now, ack);
  // Every packet before this acknowledgement had our hello.
  peer.session->knows_us = true;
  peer.session->sizes.on_ack(now, ack, peer.paths.size());
  node_.settle(now, peer, outcome);
  if (!peer.in_reach(now)) return;
  const InterfaceIndex interface = peer.paths.current()->interface;
  if (!node_.config.interfaces[interface].group_broadcast) return;
  const Node::Paces paces = node_.paces(now, interface);
  node_.group_rates[interface].on_acknowledged(
      now, node_.pacers[interface].wants(NodePacer::kGroup), peer.session->flow.quality().queue,
      paces.slowest, paces.fastest);
}

void Reception::on_frame(MeshTime now, Peer& peer, const MeshPath& from, Frame&& frame) {
  std::visit(Visitor{[&](HelloFrame& hello) {
                       if (hello.wants_answer) reply(now, peer, from);
                     },
                     [&](AckFrame& ack) { on_acknowledgement(now, peer, ack); }, [](PingFrame&) {},
                     [&](ParcelStateFrame& state) {
                       const auto finished = peer.outbox.on_state(now, state);
                       if (finished) node_.events.emplace_back(ParcelDelivered{peer.id, *finished});
                     },
                     [&](auto&) {
                       auto received = peer.inbox.on_frame(std::move(frame));
                       if (received) hand_on(peer.id, *std::move(received));
                     }},
             frame);
}

void Reception::hand_on(MemberId from, Received&& received) {
  std::visit(
      Visitor{[&](UrgentReceived& urgent) {
                node_.events.emplace_back(UrgentArrived{from, std::move(urgent.bytes)});
              },
              [&](TelemetryReceived& telemetry) {
                node_.events.emplace_back(
                    TelemetryArrived{from, telemetry.key, std::move(telemetry.bytes)});
              },
              [&](ParcelInbox::Arrived& parcel) {
                node_.events.emplace_back(
                    ParcelArrived{from, parcel.key, parcel.priority, std::move(parcel.bytes)});
              },
              [&](MapReceived& map) {
                node_.events.emplace_back(MapArrived{from, map.priority, std::move(map.bytes)});
              }},
      received);
}

// What the member that is silent the longest has begun makes room: it will be sent again.
void Reception::relieve_memory() {
  if (node_.received_budget.refused() == refused_seen_) return;
  refused_seen_ = node_.received_budget.refused();
  Peer* oldest = nullptr;
  for (const auto& [id, peer] : node_.members) {
    if (peer->liveness.up() || peer->inbox.unfinished_bytes() == 0) continue;
    if (oldest == nullptr || peer->liveness.heard() < oldest->liveness.heard()) {
      oldest = peer.get();
    }
  }
  if (oldest != nullptr) oldest->inbox.drop_partial();
}

}  // namespace warren::mesh
