// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/scheduler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace warren::mesh {
namespace {

// A path whose rate is not known yet.
constexpr double kRateMin = 1000.0;

std::size_t index_of(SendClass send_class) { return static_cast<std::size_t>(send_class); }
std::size_t index_of(MapClass map_class) { return static_cast<std::size_t>(map_class); }

SendClass send_class_of(MapClass map_class) {
  return map_class == MapClass::kFresh ? SendClass::kFresh : SendClass::kBacklog;
}

double rate_of(const SendState& state) { return std::max(state.rate_bytes_s, kRateMin); }

double burst_of(const SchedulerConfig& config, const SendState& state, double share) {
  const double saved = std::chrono::duration<double>(config.burst).count();
  return std::max(config.burst_bytes_min, rate_of(state) * share * saved);
}

// When a bucket that fills with `bytes_per_s` is open.
MeshTime open_at(MeshTime now, const TokenBucket& bucket, double bytes_per_s) {
  if (bucket.open()) return now;
  const double us = (1.0 - bucket.tokens()) / bytes_per_s * 1e6;
  return now + Duration(static_cast<Duration::rep>(std::ceil(us)) + 1);
}

}  // namespace

void FilledPacket::add(OutgoingFrame&& sent, SendClass send_class) {
  add(std::move(sent.frame), send_class);
  tickets.push_back(sent.ticket);
}

void FilledPacket::add(Frame&& frame, SendClass send_class) {
  const std::size_t size = encoded_bytes(frame);
  bytes += size;
  class_bytes[index_of(send_class)] += size;
  frames.push_back(std::move(frame));
}

struct Scheduler::Filling {
  const SendState& state;
  std::size_t room;
  Outbox& outbox;
  Inbox& inbox;
  const PullMap& pull;
  FilledPacket& packet;
  // What the caller put in is not ours to limit: were it charged, a stream of acknowledgements
  // could keep receipts from ever going.
  std::size_t given_control = packet.class_bytes[index_of(SendClass::kControl)];
  std::size_t given_frames = packet.frames.size();

  double bytes_of(SendClass send_class) const {
    return static_cast<double>(packet.class_bytes[index_of(send_class)]);
  }
  double own_control() const {
    return bytes_of(SendClass::kControl) - static_cast<double>(given_control);
  }
  std::size_t left_of(std::size_t whole) const {
    return whole > packet.bytes ? whole - packet.bytes : 0;
  }
  std::size_t left() const { return left_of(room); }
  bool add(std::optional<OutgoingFrame> frame, SendClass send_class) {
    if (!frame) return false;
    packet.add(std::move(*frame), send_class);
    return true;
  }
  bool untouched() const { return packet.frames.size() == given_frames; }
  bool add_next(SendClass send_class) { return add_next(send_class, room); }
  bool add_next(SendClass send_class, std::size_t whole) {
    const Outbox::Room place{left_of(whole), std::max(room, state.room_max)};
    return add(outbox.next(state.now, place, send_class, state.rtt), send_class);
  }
};

Scheduler::Scheduler(const SchedulerConfig& config)
    : config_(config), control_(config.burst_bytes_min), telemetry_(config.burst_bytes_min) {}

void Scheduler::fill(const SendState& state, std::size_t room, Outbox& outbox, Inbox& inbox,
                     const PullMap& pull, FilledPacket& packet) {
  Filling filling{state, room, outbox, inbox, pull, packet};
  refill(state);
  fill_small(filling);
  fill_bulk(filling);
  account(filling);
}

void Scheduler::fill_urgent(const SendState& state, std::size_t room, Outbox& outbox,
                            FilledPacket& packet) {
  while (true) {
    const std::size_t left = room > packet.bytes ? room - packet.bytes : 0;
    const Outbox::Room place{left, std::max(room, state.room_max)};
    auto frame = outbox.next(state.now, place, SendClass::kUrgent, state.rtt);
    if (!frame) return;
    packet.add(std::move(*frame), SendClass::kUrgent);
  }
}

MeshTime Scheduler::next_due(const SendState& state, const Outbox& outbox, const Inbox& inbox) {
  refill(state);
  const double rate = rate_of(state);
  const auto capped = [&](MeshTime due, const TokenBucket& bucket, double cap) {
    return due == kNever ? due : std::max(due, open_at(state.now, bucket, rate * cap));
  };
  const MeshTime control =
      inbox.answers_due() ? MeshTime::min() : outbox.next_due(SendClass::kControl);
  MeshTime due = outbox.next_due(SendClass::kUrgent);
  due = std::min(due, capped(control, control_, config_.control_cap));
  due = std::min(due,
                 capped(outbox.next_due(SendClass::kTelemetry), telemetry_, config_.telemetry_cap));
  due = std::min(due, outbox.next_due(SendClass::kControlParcel));
  due = std::min(due, outbox.next_due(SendClass::kMessageParcel));
  const bool source_asked = (source_empty_[0] && source_empty_[1]) || !state.map_fits();
  return source_asked ? due : MeshTime::min();
}

void Scheduler::refill(const SendState& state) {
  const double rate = rate_of(state);
  control_.refill(state.now, rate * config_.control_cap,
                  burst_of(config_, state, config_.control_cap));
  telemetry_.refill(state.now, rate * config_.telemetry_cap,
                    burst_of(config_, state, config_.telemetry_cap));
}

// Each taking counts at once: a packet exceeds a cap by less than one frame.
void Scheduler::fill_small(Filling& filling) {
  while (filling.add_next(SendClass::kUrgent)) {
  }
  while (control_.tokens() > filling.own_control()) {
    if (filling.add(filling.inbox.next_answer(filling.left()), SendClass::kControl)) continue;
    if (!filling.add_next(SendClass::kControl)) break;
  }
  fill_telemetry(filling);
}

// The value whose turn it is makes the packet larger than those of now, if it must and nothing else
// is in it.
void Scheduler::fill_telemetry(Filling& filling) {
  std::size_t room = std::max(filling.room, filling.untouched() ? filling.state.room_max : 0);
  while (telemetry_.tokens() > filling.bytes_of(SendClass::kTelemetry)) {
    if (!filling.add_next(SendClass::kTelemetry, room)) break;
    room = filling.room;
  }
}

// Parcels and at most one map packet, which goes last.
void Scheduler::fill_bulk(Filling& filling) {
  const auto first = owed(filling.room);
  if (first && fill_map(filling, *first)) return;
  while (filling.add_next(SendClass::kControlParcel)) {
  }
  while (filling.add_next(SendClass::kMessageParcel)) {
  }
  if (fill_map(filling, MapClass::kFresh)) return;
  fill_map(filling, MapClass::kBacklog);
}

// The map class that has waited for its share of a whole packet.
std::optional<MapClass> Scheduler::owed(std::size_t room) const {
  for (const MapClass map_class : {MapClass::kBacklog, MapClass::kFresh}) {
    if (source_empty_[index_of(map_class)]) continue;
    if (credit_[index_of(map_class)] >= static_cast<double>(room)) return map_class;
  }
  return std::nullopt;
}

bool Scheduler::fill_map(Filling& filling, MapClass wanted) {
  const SendState& state = filling.state;
  if (source_empty_[index_of(wanted)] || !state.map_fits()) return false;
  const std::size_t needed = filling.packet.bytes + MapFrame::kOverhead + state.map_bytes_min;
  const std::size_t room =
      filling.untouched() ? std::max(filling.room, std::min(needed, state.room_max)) : filling.room;
  const std::size_t least =
      std::max(state.map_bytes_min, std::min(config_.map_room_min, filling.room * 3 / 4));
  if (filling.left_of(room) < least + MapFrame::kOverhead) return false;
  const std::size_t limit = filling.left_of(room) - MapFrame::kOverhead;
  auto pulled = filling.pull(wanted, limit);
  if (!pulled) {
    source_empty_[index_of(wanted)] = true;
    credit_[index_of(wanted)] = 0.0;
    return false;
  }
  return filling.add(
      OutgoingFrame{MapFrame{wanted, std::move(pulled->bytes)}, MapTicket{pulled->ticket, wanted}},
      send_class_of(wanted));
}

void Scheduler::account(const Filling& filling) {
  const FilledPacket& packet = filling.packet;
  if (packet.frames.empty()) return;
  const auto bytes_of = [&](SendClass send_class) { return filling.bytes_of(send_class); };
  const auto overhead = static_cast<double>(filling.state.overhead_bytes);
  const double whole = static_cast<double>(packet.bytes) + overhead;
  const double bulk = bytes_of(SendClass::kControlParcel) + bytes_of(SendClass::kMessageParcel) +
                      bytes_of(SendClass::kFresh) + bytes_of(SendClass::kBacklog);
  // Who is alone in a packet pays for what is around it.
  const bool telemetry_pays = bulk == 0.0 && bytes_of(SendClass::kTelemetry) > 0.0;
  const bool control_pays = bulk == 0.0 && !telemetry_pays && filling.own_control() > 0.0;
  control_.take(filling.own_control() + (control_pays ? overhead : 0.0));
  telemetry_.take(bytes_of(SendClass::kTelemetry) + (telemetry_pays ? overhead : 0.0));

  const auto settle = [&](MapClass map_class, double share) {
    double& credit = credit_[index_of(map_class)];
    if (source_empty_[index_of(map_class)]) return;
    const double sent = bytes_of(send_class_of(map_class));
    const double paid = sent > 0.0 ? sent + overhead : 0.0;
    const double most = 2.0 * static_cast<double>(filling.room);
    credit = std::clamp(credit + share * whole - paid, 0.0, most);
  };
  settle(MapClass::kFresh, config_.fresh_share);
  settle(MapClass::kBacklog, config_.backlog_share);
}

}  // namespace warren::mesh
