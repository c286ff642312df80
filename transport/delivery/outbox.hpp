// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <tl/expected.hpp>

#include "transport/delivery/delivery_config.hpp"
#include "transport/delivery/delivery_counts.hpp"
#include "transport/delivery/outgoing_frame.hpp"
#include "transport/delivery/parcel_outbox.hpp"
#include "transport/delivery/send_class.hpp"
#include "transport/delivery/telemetry_outbox.hpp"
#include "transport/delivery/urgent_outbox.hpp"

namespace warren::mesh {

// Everything on its way to one peer, but map packets and the answers that the inbox owes. Each
// ticket is handed back by on_acked() or on_lost(), perhaps several times: what was told lost may
// arrive after all. Tickets of before on_peer_restarted() may only come back lost.
class Outbox {
 public:
  // The board and the budget outlive it. `first_urgent`: this life of ours has used no number from
  // it on in urgent messages to the peer.
  Outbox(const DeliveryConfig& config, std::uint64_t fresh_stream, const TelemetryBoard& board,
         ParcelBudget& budget, std::uint32_t first_urgent = 0);

  // Precondition: at most UrgentFrame::kBytesMax.
  void send_urgent(MeshTime now, std::span<const std::uint8_t> bytes) { urgent_.send(now, bytes); }
  void on_telemetry_set(std::uint16_t key) { telemetry_.on_set(key); }
  tl::expected<ParcelKey, ParcelRefusal> send_parcel(ParcelClass priority,
                                                     std::span<const std::uint8_t> bytes) {
    return parcels_.send(priority, bytes);
  }

  // The next frame of a class in at most `room` bytes, if there is one now. Control: questions
  // about parcels. Never kFresh, kBacklog.
  struct Room {
    std::size_t left = 0;   // at least 128 in an empty packet
    std::size_t whole = 0;  // of the largest packet that the path carries
  };
  std::optional<OutgoingFrame> next(MeshTime now, Room room, SendClass send_class, Duration rtt);
  // When next() of this class has something without anything else happening; the distant past: now.
  MeshTime next_due(SendClass send_class) const;

  // The same frame once more, if it still makes sense and fits; what is believed to be on its way
  // stays as it is.
  std::optional<OutgoingFrame> again(const Ticket& ticket, std::size_t room) const;
  void on_acked(MeshTime now, const Ticket& ticket);
  void on_lost(MeshTime now, const Ticket& ticket);
  std::optional<ParcelKey> on_state(MeshTime now, const ParcelStateFrame& state) {
    return parcels_.on_state(now, state);
  }
  // A new life of the peer was heard: it knows nothing but what its store has.
  void on_peer_restarted();

  const OutboxCounts& counts() const { return counts_; }
  std::size_t unfinished_bytes() const { return parcels_.unfinished_bytes(); }
  std::uint32_t next_urgent() const { return urgent_.next_number(); }
  SavedOutgoing save() const { return parcels_.save(); }
  void restore(SavedOutgoing saved) { parcels_.restore(std::move(saved)); }

 private:
  OutboxCounts counts_;
  UrgentOutbox urgent_;
  TelemetryOutbox telemetry_;
  ParcelOutbox parcels_;
};

}  // namespace warren::mesh
