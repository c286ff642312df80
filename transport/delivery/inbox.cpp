// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/inbox.hpp"

#include <utility>

namespace warren::mesh {

std::optional<Received> Inbox::on_frame(Frame&& frame) {
  if (auto* urgent = std::get_if<UrgentFrame>(&frame)) return on_urgent(std::move(*urgent));
  if (auto* value = std::get_if<TelemetryFrame>(&frame)) return on_telemetry(std::move(*value));
  if (const auto* fragment = std::get_if<ParcelFrame>(&frame)) {
    auto arrived = parcels_.on_fragment(*fragment);
    if (arrived) return std::move(*arrived);
    return std::nullopt;
  }
  if (auto* map = std::get_if<MapFrame>(&frame))
    return MapReceived{map->priority, std::move(map->bytes)};
  ++counts_.unexpected_frames;
  return std::nullopt;
}

std::optional<Received> Inbox::on_urgent(UrgentFrame&& frame) {
  if (!urgent_.take(frame.number)) {
    ++counts_.urgent_duplicate;
    return std::nullopt;
  }
  ++counts_.urgent_delivered;
  return UrgentReceived{std::move(frame.bytes)};
}

std::optional<Received> Inbox::on_telemetry(TelemetryFrame&& frame) {
  switch (telemetry_.take(frame.key, frame.version)) {
    case TelemetryVersions::Verdict::kNew:
      ++counts_.telemetry_delivered;
      return TelemetryReceived{frame.key, std::move(frame.bytes)};
    case TelemetryVersions::Verdict::kStale:
      ++counts_.telemetry_stale;
      break;
    case TelemetryVersions::Verdict::kTooManyKeys:
      ++counts_.telemetry_refused;
      break;
  }
  return std::nullopt;
}

void Inbox::on_lost(const Ticket& ticket) {
  if (const auto* state = std::get_if<ParcelStateTicket>(&ticket)) parcels_.on_lost(*state);
}

void Inbox::on_peer_restarted() {
  urgent_ = {};
  telemetry_ = {};
  parcels_.on_peer_restarted();
}

}  // namespace warren::mesh
