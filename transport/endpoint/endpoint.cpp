// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/endpoint.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "transport/delivery/saved_parcels.hpp"
#include "transport/endpoint/discovery.hpp"
#include "transport/endpoint/node.hpp"
#include "transport/endpoint/reception.hpp"
#include "transport/endpoint/transmission.hpp"

namespace warren::mesh {

struct Endpoint::State {
  State(const EndpointConfig& config, std::shared_ptr<const KeySchedule> keys, MapSource& source)
      : node(config, std::move(keys), source),
        discovery(node),
        reception(node, discovery),
        transmission(node) {
    node.on_forget = [this](Peer& peer) { transmission.forget(peer); };
  }

  void refresh(MeshTime now, Peer* peer) {
    if (peer != nullptr) transmission.refresh(now, *peer);
    if (!std::exchange(node.somebody_came_up, false)) return;
    for (std::size_t i = 0; i < node.config.interfaces.size(); ++i) {
      transmission.wake_group(static_cast<InterfaceIndex>(i));
    }
  }

  Node node;
  Discovery discovery;
  Reception reception;
  Transmission transmission;
  // When poll_transmit() had nothing more to send.
  MeshTime idle_at = MeshTime::min();
};

Endpoint::Endpoint(const EndpointConfig& config, std::shared_ptr<const KeySchedule> keys,
                   MapSource& source)
    : state_(std::make_unique<State>(config, std::move(keys), source)) {
  assert(!config.interfaces.empty() && Node::can_be_member(config.self));
  assert(std::all_of(
      config.interfaces.begin(), config.interfaces.end(),
      [](const InterfaceConfig& c) { return c.mtu_bytes >= InterfaceConfig::kMtuLeast; }));
}

Endpoint::~Endpoint() = default;

void Endpoint::on_datagram(MeshTime now, const MeshPath& from,
                           std::span<const std::uint8_t> bytes) {
  state_->refresh(now, state_->reception.on_datagram(now, from, bytes));
}

std::optional<Datagram> Endpoint::poll_transmit(MeshTime now) {
  auto datagram = state_->discovery.poll(now);
  if (!datagram) datagram = state_->transmission.poll(now);
  if (!datagram) state_->idle_at = now;
  return datagram;
}

MeshTime Endpoint::next_deadline() const {
  return std::min(state_->discovery.next(), state_->transmission.next(state_->idle_at));
}

std::optional<MeshEvent> Endpoint::poll_event() {
  auto& events = state_->node.events;
  if (events.empty()) return std::nullopt;
  MeshEvent event = std::move(events.front());
  events.pop_front();
  return event;
}

tl::expected<void, SendError> Endpoint::send_urgent(MeshTime now, std::optional<MemberId> to,
                                                    std::span<const std::uint8_t> bytes) {
  if (bytes.size() > UrgentFrame::kBytesMax) return tl::unexpected(SendError::kTooLarge);
  if (to && state_->node.members.find(*to) == nullptr) {
    return tl::unexpected(SendError::kUnknownMember);
  }
  for (const auto& [id, peer] : state_->node.members) {
    if (to ? id != *to : !peer->liveness.up()) continue;
    peer->outbox.send_urgent(now, bytes);
    state_->refresh(now, peer.get());
  }
  return {};
}

tl::expected<void, SendError> Endpoint::set_telemetry(MeshTime now, std::uint16_t key,
                                                      std::span<const std::uint8_t> bytes) {
  if (bytes.size() > TelemetryFrame::kBytesMax) return tl::unexpected(SendError::kTooLarge);
  if (!state_->node.board.set(key, bytes)) return tl::unexpected(SendError::kFull);
  for (const auto& [id, peer] : state_->node.members) {
    peer->outbox.on_telemetry_set(key);
    state_->refresh(now, peer.get());
  }
  return {};
}

tl::expected<ParcelKey, SendError> Endpoint::send_parcel(MeshTime now, MemberId to,
                                                         ParcelClass priority,
                                                         std::span<const std::uint8_t> bytes) {
  if (!state_->node.can_be_peer(to)) return tl::unexpected(SendError::kUnknownMember);
  Peer* peer = state_->node.find_or_add(now, to);
  if (peer == nullptr) return tl::unexpected(SendError::kFull);
  const auto key = peer->outbox.send_parcel(priority, bytes);
  if (!key) {
    return tl::unexpected(key.error() == ParcelRefusal::kTooLarge ? SendError::kTooLarge
                                                                  : SendError::kFull);
  }
  state_->refresh(now, peer);
  return *key;
}

void Endpoint::finish_parcel(MeshTime now, MemberId from, ParcelKey key) {
  Peer* peer = state_->node.members.find(from);
  if (peer == nullptr) return;
  peer->inbox.finish_parcel(key);
  state_->refresh(now, peer);
}

void Endpoint::wake(MeshTime now, MemberId member) {
  Peer* peer = state_->node.members.find(member);
  if (peer == nullptr) return;
  peer->scheduler.wake();
  state_->refresh(now, peer);
}

void Endpoint::wake_group(InterfaceIndex interface) { state_->transmission.wake_group(interface); }

std::vector<Member> Endpoint::members() const {
  std::vector<Member> members;
  for (const auto& [id, peer] : state_->node.members) {
    if (!peer->session) continue;
    members.push_back({id, peer->session->keys.peer(), peer->paths.current().value_or(MeshPath{}),
                       peer->session->since, peer->liveness.heard(), peer->liveness.up(),
                       peer->session->flow.quality()});
  }
  return members;
}

EndpointCounts Endpoint::counts() const {
  EndpointCounts counts = state_->node.counts;
  for (const auto& [id, peer] : state_->node.members) {
    counts.outbox += peer->outbox.counts();
    counts.inbox += peer->inbox.counts();
  }
  return counts;
}

std::size_t Endpoint::memory_bytes() const {
  std::size_t bytes = sizeof(State) + state_->discovery.memory_bytes();
  for (const auto& [id, peer] : state_->node.members) {
    bytes += sizeof(Peer) + peer->outbox.unfinished_bytes() + peer->inbox.unfinished_bytes();
    if (peer->session) bytes += peer->session->flow.memory_bytes();
  }
  return bytes;
}

std::vector<std::uint8_t> Endpoint::save() const {
  std::vector<SavedPeer> saved;
  for (const auto& [id, peer] : state_->node.members) {
    saved.push_back({id, peer->outbox.save(), peer->inbox.save()});
  }
  return encode(saved);
}

bool Endpoint::restore(std::span<const std::uint8_t> saved) {
  auto peers = read_saved_parcels(saved);
  if (!peers || peers->size() > state_->node.config.members_max) return false;
  for (SavedPeer& from : *peers) {
    // Nothing was there before: nobody is forgotten for it.
    Peer* peer = state_->node.find_or_add(MeshTime::min(), from.member);
    assert(peer != nullptr);
    peer->outbox.restore(std::move(from.outgoing));
    peer->inbox.restore(from.incoming);
  }
  return true;
}

}  // namespace warren::mesh
