// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/packet_builder.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace warren::mesh {
namespace {

// What a packet is about to be.
struct Draft {
  MeshPath to;
  std::size_t room = 0;  // of the content
  FilledPacket packet;
  bool repeat = false;
  bool goes_again = false;  // an answer with tries left
};

bool answer_is_due(MeshTime now, const Peer& peer) { return peer.answer && peer.answer->at <= now; }

std::size_t room_of(const Node& node, InterfaceIndex interface, std::size_t ip_bytes) {
  const std::size_t overhead = node.config.interfaces[interface].ip_header_bytes + kEnvelopeBytes;
  assert(ip_bytes > overhead);
  return ip_bytes - overhead;
}

bool add_control(Draft& draft, Frame frame) {
  const std::size_t bytes = encoded_bytes(frame);
  if (draft.packet.bytes + bytes > draft.room) return false;
  draft.packet.frames.push_back(std::move(frame));
  draft.packet.bytes += bytes;
  draft.packet.class_bytes[static_cast<std::size_t>(SendClass::kControl)] += bytes;
  return true;
}

void add_hello(Draft& draft, MeshTime now, const Node& node, Peer& peer) {
  const bool answers = answer_is_due(now, peer);
  if (!answers && peer.session->knows_us) return;
  add_control(draft, HelloFrame{node.config.self, answers && peer.answer->wants_answer});
  if (!answers) return;
  if (--peer.answer->tries > 0) {
    peer.answer->at = now + Peer::kTryAgain;
    draft.goes_again = true;
  } else {
    peer.answer.reset();
  }
}

void add_acknowledgement(Draft& draft, MeshTime now, Flow& flow) {
  if (!flow.ack_pending() && !flow.ack_due(now)) return;
  if (auto ack = flow.take_ack(now)) add_control(draft, *std::move(ack));
}

// A packet as large as the path is said to carry, or a small one, to see whether it passes. True:
// nothing else belongs into it.
bool add_size_probe(Draft& draft, const Node& node, MeshTime now, Peer& peer) {
  PacketSize& size = peer.paths.size();
  if (size.wants_large_probe(now)) {
    size.on_large_probe(now);
    draft.room =
        room_of(node, draft.to.interface, node.config.interfaces[draft.to.interface].mtu_bytes);
    PingFrame ping;
    while (draft.packet.bytes + encoded_bytes(ping) < draft.room) {
      const std::size_t missing = draft.room - draft.packet.bytes - encoded_bytes(ping);
      ping.padding = static_cast<std::uint16_t>(ping.padding + missing);
    }
    while (draft.packet.bytes + encoded_bytes(ping) > draft.room) --ping.padding;
    return add_control(draft, ping);
  }
  if (!size.wants_small_probe()) return false;
  size.on_small_probe();
  return add_control(draft, PingFrame{});
}

void add_repeat(Draft& draft, Peer& peer) {
  const auto repeat = std::exchange(peer.repeat, std::nullopt);
  if (!repeat) return;
  for (const Ticket& ticket : *repeat) {
    auto again = peer.outbox.again(ticket, draft.room - draft.packet.bytes);
    if (!again) continue;
    draft.packet.bytes += encoded_bytes(again->frame);
    draft.packet.frames.push_back(std::move(again->frame));
    draft.packet.tickets.push_back(again->ticket);
    draft.repeat = true;
  }
}

PullMap pull_for(Node& node, const Peer& peer) {
  return [&node, id = peer.id](MapClass wanted, std::size_t limit) -> std::optional<PulledMap> {
    auto packet = node.source.next_for(id, wanted, limit);
    if (!packet) return std::nullopt;
    assert(packet->bytes.size() <= limit && packet->priority == wanted);
    return PulledMap{packet->ticket, std::move(packet->bytes)};
  };
}

std::optional<Datagram> send(Node& node, MeshTime now, Peer& peer, Draft& draft) {
  if (draft.packet.frames.empty()) return std::nullopt;
  Session& session = *peer.session;
  std::vector<std::uint8_t> content;
  content.reserve(draft.packet.bytes);
  bool wants_ack = false;
  for (const Frame& frame : draft.packet.frames) {
    append(content, frame);
    wants_ack = wants_ack || !std::holds_alternative<AckFrame>(frame);
  }
  const std::uint64_t number = session.keys.next_number();
  Datagram datagram{draft.to, session.keys.seal(content)};
  const std::size_t ip_bytes = node.ip_bytes(draft.to.interface, datagram.bytes.size());
  const bool backlogged =
      node.pacers[draft.to.interface].on_sent(now, peer.id.number, ip_bytes, session.flow.pace());
  if (draft.goes_again && !draft.packet.tickets.empty()) peer.repeat = draft.packet.tickets;
  session.sizes.on_sent(now, number, ip_bytes);
  session.flow.on_sent(now, {number, ip_bytes, wants_ack, backlogged, draft.repeat,
                             std::move(draft.packet.tickets)});
  if (wants_ack && !session.awaiting_since) session.awaiting_since = now;
  node.count_sent(ip_bytes);
  for (std::size_t i = 0; i < kSendClasses; ++i) {
    if (draft.packet.class_bytes[i] == 0) continue;
    ++node.counts.sent[i].packets;
    node.counts.sent[i].bytes += draft.packet.class_bytes[i];
  }
  return datagram;
}

}  // namespace

SendState send_state(const Node& node, MeshTime now, const Peer& peer) {
  const Flow& flow = peer.session->flow;
  const auto path = peer.paths.current();
  const InterfaceIndex interface = path ? path->interface : InterfaceIndex { 0 };
  const InterfaceConfig& config = node.config.interfaces[interface];
  return {now,
          flow.pace(),
          flow.quality().rtt.value_or(Duration{}),
          config.ip_header_bytes + kEnvelopeBytes,
          path ? room_of(node, interface, peer.paths.size().limit(config.mtu_bytes)) : 0,
          node.source.bytes_min()};
}

std::optional<Datagram> build_packet(Node& node, MeshTime now, Peer& peer, PacketFill fill) {
  Flow& flow = peer.session->flow;
  Draft draft;
  draft.to = answer_is_due(now, peer) ? peer.answer->path : *peer.paths.current();
  const std::size_t mtu = node.config.interfaces[draft.to.interface].mtu_bytes;
  draft.room = room_of(node, draft.to.interface,
                       std::min(peer.paths.size().limit(mtu), flow.packet_bytes()));
  // What skips its turn is limited too, but for acknowledgements.
  const bool at_once = fill == PacketFill::kEverything || flow.may_send_at_once(now);
  if (at_once) add_hello(draft, now, node, peer);
  add_acknowledgement(draft, now, flow);
  const SendState state = send_state(node, now, peer);
  if (fill == PacketFill::kUrgentOnly) {
    if (at_once) peer.scheduler.fill_urgent(state, draft.room, peer.outbox, draft.packet);
    return send(node, now, peer, draft);
  }
  if (add_size_probe(draft, node, now, peer)) return send(node, now, peer, draft);
  peer.scheduler.fill(state, draft.room, peer.outbox, peer.inbox, pull_for(node, peer),
                      draft.packet);
  if (draft.packet.tickets.empty()) add_repeat(draft, peer);
  return send(node, now, peer, draft);
}

}  // namespace warren::mesh
