// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "transport/delivery/delivery_config.hpp"
#include "transport/delivery/delivery_counts.hpp"
#include "transport/delivery/parcel_inbox.hpp"
#include "transport/delivery/telemetry_versions.hpp"
#include "transport/delivery/urgent_window.hpp"

namespace warren::mesh {

// What an inbox hands on.
struct UrgentReceived {
  std::vector<std::uint8_t> bytes;
};
struct TelemetryReceived {
  std::uint16_t key;
  std::vector<std::uint8_t> bytes;
};
struct MapReceived {
  MapClass priority;
  std::vector<std::uint8_t> bytes;
};
using Received = std::variant<UrgentReceived, TelemetryReceived, ParcelInbox::Arrived, MapReceived>;

// Everything that comes from one peer: duplicates and stale values end here.
class Inbox {
 public:
  // The budget outlives it.
  Inbox(const DeliveryConfig& config, ParcelBudget& budget)
      : parcels_(config.parcel, budget, counts_) {}

  // Of the kinds urgent, telemetry, parcel and map; others are the endpoint's. Takes nothing on
  // trust.
  std::optional<Received> on_frame(Frame&& frame);
  void finish_parcel(const ParcelKey& key) { parcels_.finish(key); }

  // A state frame that is due: of the control class.
  std::optional<OutgoingFrame> next_answer(std::size_t room) { return parcels_.next_answer(room); }
  bool answers_due() const { return parcels_.answers_due(); }
  void on_lost(const Ticket& ticket);
  // A new life of the peer was heard: its urgent numbers and versions begin anew.
  void on_peer_restarted();

  const InboxCounts& counts() const { return counts_; }
  void drop_partial() { parcels_.drop_partial(); }
  std::size_t unfinished_bytes() const { return parcels_.unfinished_bytes(); }
  std::size_t unfinished_parcels() const { return parcels_.handed_on(); }
  SavedIncoming save() const { return parcels_.save(); }
  void restore(const SavedIncoming& saved) { parcels_.restore(saved); }

 private:
  std::optional<Received> on_urgent(UrgentFrame&& frame);
  std::optional<Received> on_telemetry(TelemetryFrame&& frame);

  InboxCounts counts_;
  UrgentWindow urgent_;
  TelemetryVersions telemetry_;
  ParcelInbox parcels_;
};

}  // namespace warren::mesh
