// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/outbox.hpp"

#include <variant>

namespace warren::mesh {
namespace {

MeshTime due_now_if(bool any) { return any ? MeshTime::min() : kNever; }

}  // namespace

Outbox::Outbox(const DeliveryConfig& config, std::uint64_t fresh_stream,
               const TelemetryBoard& board, ParcelBudget& budget, std::uint32_t first_urgent)
    : urgent_(config.urgent, counts_, first_urgent),
      telemetry_(board, counts_),
      parcels_(config.parcel, fresh_stream, budget, counts_) {}

std::optional<OutgoingFrame> Outbox::next(MeshTime now, Room room, SendClass send_class,
                                          Duration rtt) {
  switch (send_class) {
    case SendClass::kUrgent:
      return urgent_.next(now, room.left, rtt);
    case SendClass::kControl:
      return parcels_.next_question(now, room.left);
    case SendClass::kTelemetry:
      return telemetry_.next(room.left, room.whole);
    case SendClass::kControlParcel:
      return parcels_.next(room.left, ParcelClass::kControl);
    case SendClass::kMessageParcel:
      return parcels_.next(room.left, ParcelClass::kMessage);
    case SendClass::kFresh:
    case SendClass::kBacklog:
      break;
  }
  return std::nullopt;
}

MeshTime Outbox::next_due(SendClass send_class) const {
  switch (send_class) {
    case SendClass::kUrgent:
      return urgent_.next_due();
    case SendClass::kControl:
      return parcels_.question_due();
    case SendClass::kTelemetry:
      return due_now_if(!telemetry_.empty());
    case SendClass::kControlParcel:
      return due_now_if(parcels_.has_fragment(ParcelClass::kControl));
    case SendClass::kMessageParcel:
      return due_now_if(parcels_.has_fragment(ParcelClass::kMessage));
    case SendClass::kFresh:
    case SendClass::kBacklog:
      break;
  }
  return kNever;
}

std::optional<OutgoingFrame> Outbox::again(const Ticket& ticket, std::size_t room) const {
  std::optional<OutgoingFrame> frame;
  if (const auto* urgent = std::get_if<UrgentTicket>(&ticket)) frame = urgent_.again(*urgent);
  if (const auto* value = std::get_if<TelemetryTicket>(&ticket)) frame = telemetry_.again(*value);
  if (const auto* fragment = std::get_if<FragmentTicket>(&ticket))
    frame = parcels_.again(*fragment);
  if (frame && encoded_bytes(frame->frame) > room) return std::nullopt;
  return frame;
}

void Outbox::on_acked(MeshTime now, const Ticket& ticket) {
  if (const auto* urgent = std::get_if<UrgentTicket>(&ticket)) urgent_.on_acked(*urgent);
  if (const auto* value = std::get_if<TelemetryTicket>(&ticket)) telemetry_.on_acked(*value);
  if (const auto* fragment = std::get_if<FragmentTicket>(&ticket))
    parcels_.on_acked(now, *fragment);
}

void Outbox::on_lost(MeshTime now, const Ticket& ticket) {
  if (const auto* value = std::get_if<TelemetryTicket>(&ticket)) telemetry_.on_lost(*value);
  if (const auto* fragment = std::get_if<FragmentTicket>(&ticket)) parcels_.on_lost(now, *fragment);
}

void Outbox::on_peer_restarted() {
  telemetry_.send_all();
  parcels_.on_peer_restarted();
}

}  // namespace warren::mesh
