// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/replication.hpp"

#include <algorithm>
#include <utility>

#include "transport/delivery/telemetry_board.hpp"
#include "transport/visitor.hpp"

namespace warren::replication {

using mesh::Visitor;

// And some of the daemon's.
static_assert(2 * kSlotsMax + 16 <= mesh::TelemetryBoard::kKeysMax);

Replication::Replication(const ReplicationConfig& config)
    : node_(config),
      serving_(node_),
      pulling_(node_),
      walk_(node_, pulling_),
      announcing_(node_, pulling_, walk_),
      logs_(node_.config, node_.commands) {}

void Replication::on_published(MeshTime now, const LayerId& layer) {
  node_.now = now;
  node_.book.on_published(now, layer);
}

void Replication::on_position(MeshTime now, const Eigen::Vector3d& position_fleet) {
  node_.now = now;
  pulling_.on_position(position_fleet);
}

void Replication::set_up(MemberId member, bool up) {
  Peer* const peer = node_.find_or_add(member);
  if (peer == nullptr) return;
  peer->up = up;
  logs_.on_up(member, up);
  if (!up) return pulling_.on_down();
  pulling_.on_up(*peer);
  serving_.on_up(*peer);
}

// Another life: it knows nothing of what we told it.
void Replication::on_restarted(Peer& peer) {
  Peer fresh;
  fresh.id = peer.id;
  fresh.up = peer.up;
  fresh.interface = peer.interface;
  fresh.traffic_in = peer.traffic_in;
  fresh.traffic_out = peer.traffic_out;
  peer = std::move(fresh);
  pulling_.on_restarted(peer);
  logs_.on_restarted(peer.id);
}

// It may come back as somebody new.
void Replication::on_forgotten(MemberId member) {
  Peer* const peer = node_.find(member);
  if (peer == nullptr) return;
  set_up(member, false);
  on_restarted(*peer);
  logs_.on_forgotten(member);
  node_.peers.erase(member);
}

void Replication::on_telemetry(Peer& from, const mesh::TelemetryArrived& telemetry) {
  if (telemetry.key >= kLayerKeys && telemetry.key < kLayerKeys + kSlotsMax) {
    const auto slot = static_cast<Slot>(telemetry.key - kLayerKeys);
    const HeldLayer* const layer = pulling_.on_announcement(from, slot, telemetry.bytes);
    if (layer == nullptr) return;
    if (layer->own != nullptr) return look_behind(*layer, from);
    walk_.look(*layer);
  } else if (telemetry.key >= kLogKeys && telemetry.key < kLogKeys + kSlotsMax) {
    logs_.on_announcement(from.id, static_cast<Slot>(telemetry.key - kLogKeys), telemetry.bytes);
  }
}

void Replication::look_behind(const HeldLayer& own, const Peer& from) {
  const Announcement* const said = from.find(own.id);
  if (said == nullptr) return;
  const Revision held = said->holdings.highest({});
  if (held <= own.highest()) return;
  ahead_of_us_.try_emplace(own.id, HeldAhead{from.id, held, own.highest()});
}

void Replication::on_map(Peer& from, const mesh::MapArrived& map) {
  if (logs_.on_message(from.id, map.bytes)) return;
  const auto message = read_map_message(map.bytes);
  if (!message) {
    ++node_.refused.malformed_messages;
    return;
  }
  std::visit(Visitor{[&](const DiffMessage& diff) {
                       auto& bytes = map.priority == mesh::MapClass::kFresh
                                         ? from.traffic_in.fresh_bytes
                                         : from.traffic_in.backlog_bytes;
                       bytes += map.bytes.size();
                       const HeldLayer* const layer = pulling_.on_diff(from, diff);
                       if (layer != nullptr) serving_.on_news(*layer);
                     },
                     [&](const WishMessage& wishes) {
                       from.traffic_in.other_bytes += map.bytes.size();
                       for (const Wish& wish : wishes.wishes) serving_.on_wish(from, wish);
                     },
                     [&](const DigestQuestion& question) { walk_.on_question(from, question); },
                     [&](const DigestAnswer& answer) { walk_.on_answer(from, answer); }},
             *message);
}

void Replication::on_event(MeshTime now, const mesh::MeshEvent& event) {
  node_.now = now;
  const auto with = [&](MemberId member, auto&& act) {
    if (Peer* const peer = node_.find_or_add(member)) act(*peer);
  };
  std::visit(
      Visitor{[&](const mesh::MemberUp& up) { set_up(up.member, true); },
              [&](const mesh::MemberDown& down) { set_up(down.member, false); },
              [&](const mesh::MemberRestarted& restarted) {
                with(restarted.member, [&](Peer& peer) { on_restarted(peer); });
              },
              [&](const mesh::MemberForgotten& gone) { on_forgotten(gone.member); },
              [&](const mesh::MemberMoved& moved) {
                with(moved.member, [&](Peer& peer) { peer.interface = moved.path.interface; });
              },
              [&](const mesh::TelemetryArrived& telemetry) {
                with(telemetry.from, [&](Peer& peer) { on_telemetry(peer, telemetry); });
              },
              [&](const mesh::MapArrived& map) {
                with(map.from, [&](Peer& peer) { on_map(peer, map); });
              },
              [&](const mesh::ParcelArrived& parcel) {
                with(parcel.from, [&](Peer&) { (void)logs_.on_parcel(now, parcel); });
              },
              [&](const mesh::ParcelDelivered& delivered) { logs_.on_parcel_delivered(delivered); },
              [](const auto&) {}},
      event);
}

void Replication::on_members(std::span<const mesh::Member> members) {
  for (const mesh::Member& member : members) {
    Peer* const peer = node_.find(member.id);
    if (peer == nullptr) continue;
    peer->link = member.link;
    peer->interface = member.path.interface;
  }
}

void Replication::advance(MeshTime now) {
  node_.now = now;
  if (layers_placed_ != node_.book.layers().size()) take_poses();
  node_.book.review_room(now);
  pulling_.advance();
  announcing_.advance();
  logs_.advance(now);
}

MeshTime Replication::next_deadline() const {
  if (!node_.commands.empty()) return node_.now;
  return std::min({pulling_.next_deadline(), announcing_.next_deadline(), logs_.next_deadline()});
}

std::optional<Command> Replication::poll_command() {
  std::optional<Command> command;
  if (node_.commands.empty()) return command;
  command.emplace(std::move(node_.commands.front()));
  node_.commands.pop_front();
  return command;
}

StoreBatch Replication::take_batch() {
  const std::uint64_t number = ++batches_;
  logs_.on_batch(number);
  return {number, node_.book.take_batch(number), logs_.book().take_batch(number)};
}

void Replication::on_stored(MeshTime now, std::uint64_t batch) {
  node_.now = now;
  for (const HeldLayer* const layer : node_.book.on_stored(batch)) serving_.on_news(*layer);
  logs_.on_stored(now, batch);
}

void Replication::on_refused(std::uint64_t batch) {
  node_.book.on_refused(batch);
  logs_.on_refused(batch);
}

void Replication::take_pose(const Item& item) {
  const auto written = read_layer_pose(item);
  HeldLayer* const layer = written ? node_.book.find(written->layer) : nullptr;
  if (layer == nullptr || !layer->copy || written->correction) return;
  (void)layer->copy->pose().update_origin(written->pose);
}

// A layer may come after its pose.
void Replication::take_poses() {
  layers_placed_ = node_.book.layers().size();
  for (const auto& held : logs_.book().logs()) {
    for (const auto& [number, item] : held->log.items()) take_pose(item);
  }
}

bool Replication::restore_logs(MeshTime now, std::span<const StoredLog> logs) {
  layers_placed_ = 0;
  return logs_.book().restore(now, logs);
}

std::optional<ItemNumber> Replication::append(MeshTime now, Item item) {
  take_pose(item);
  return logs_.book().append(now, std::move(item));
}

std::optional<ArrivedItem> Replication::poll_item() {
  auto arrived = logs_.book().poll_arrived();
  if (arrived) take_pose(arrived->item);
  return arrived;
}

const Pull* Replication::pull_of(const LayerId& layer) const {
  const HeldLayer* const held = node_.book.find(layer);
  return held == nullptr ? nullptr : pulling_.find(*held);
}

std::optional<mesh::MapSource::Packet> Replication::next_for(MemberId to, mesh::MapClass wanted,
                                                             std::size_t limit) {
  Peer* const peer = node_.find(to);
  if (peer == nullptr) return std::nullopt;
  if (wanted == mesh::MapClass::kFresh) {
    if (auto wishes = next_wishes(*peer, limit)) return wishes;
  }
  auto packet = serving_.next_for(*peer, wanted, limit);
  while (peer->sent.size() > Peer::kSentMax) peer->sent.erase(peer->sent.begin());
  return packet;
}

std::optional<mesh::MapSource::Packet> Replication::next_wishes(Peer& to, std::size_t limit) {
  if (auto wishes = pulling_.next_for(to, limit)) return wishes;
  if (auto digest = walk_.next_for(to, limit)) return digest;
  LogWishesSent told;
  auto message = logs_.next_wishes(to.id, limit, told.slots);
  if (!message) return std::nullopt;
  const std::uint64_t ticket = node_.next_ticket++;
  to.sent[ticket] = std::move(told);
  to.traffic_out.other_bytes += message->size();
  return Packet{ticket, mesh::MapClass::kFresh, std::move(*message)};
}

std::optional<mesh::MapSource::Packet> Replication::next_for_group(InterfaceIndex interface,
                                                                   std::size_t limit) {
  return serving_.next_for_group(interface, limit);
}

void Replication::on_acknowledged(MemberId from, std::uint64_t ticket) {
  Peer* const peer = node_.find(from);
  if (peer == nullptr) return;
  const auto found = peer->sent.find(ticket);
  if (found == peer->sent.end()) return;
  const Sent sent = std::move(found->second);
  peer->sent.erase(found);
  std::visit(
      Visitor{[&](const DiffSent& diff) { serving_.on_acknowledged(*peer, diff.slot, ticket); },
              [&](const WishesSent& wishes) { pulling_.on_acknowledged(wishes); },
              [](const auto&) {}},
      sent);
}

void Replication::on_lost(MemberId from, std::uint64_t ticket) {
  Peer* const peer = node_.find(from);
  if (peer == nullptr) return;
  const auto found = peer->sent.find(ticket);
  if (found == peer->sent.end()) return;
  std::visit(Visitor{[&](const DiffSent& diff) { serving_.on_lost(*peer, diff.slot, ticket); },
                     [&](const WishesSent& wishes) { pulling_.on_lost(*peer, wishes); },
                     [&](const LogWishesSent& wishes) { logs_.on_wishes_lost(from, wishes.slots); },
                     [&](const DigestSent& digest) { walk_.on_lost(*peer, digest); }},
             found->second);
}

std::size_t Replication::memory_bytes() const {
  std::size_t bytes = sizeof(*this) + node_.book.memory_bytes() + logs_.memory_bytes();
  for (const auto& [id, peer] : node_.peers) {
    bytes += sizeof(Peer) + peer.sent.size() * 80;
    bytes += peer.announced.size() * (sizeof(Announcement) + 128);
    for (const auto& [slot, subscription] : peer.subscriptions)
      bytes += subscription.memory_bytes();
  }
  return bytes;
}

}  // namespace warren::replication
