// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "transport/delivery/delivery_counts.hpp"
#include "transport/delivery/outgoing_frame.hpp"
#include "transport/delivery/telemetry_board.hpp"

namespace warren::mesh {

// To one peer, of each key the latest value only, read at the moment of sending. Keys take turns.
class TelemetryOutbox {
 public:
  // Everything on the board is to be sent.
  TelemetryOutbox(const TelemetryBoard& board, OutboxCounts& counts);

  // The board has a new value of it.
  void on_set(std::uint16_t key);
  // Of the key that waits longest among those that fit. What does not even fit into `whole`, the
  // room of the path's largest packet, waits no longer.
  std::optional<OutgoingFrame> next(std::size_t room, std::size_t whole);
  // Of this very version, if it is the latest still.
  std::optional<OutgoingFrame> again(const TelemetryTicket& ticket) const;
  bool empty() const { return waiting_.empty(); }
  void on_acked(const TelemetryTicket& ticket);
  // The current value goes again, unless a newer one than the lost one has gone.
  void on_lost(const TelemetryTicket& ticket);
  // The peer knows nothing any more.
  void send_all();

 private:
  struct Key {
    std::optional<std::uint32_t> sent;  // latest version sent
    bool waiting = false;               // in waiting_
  };
  void wait(std::uint16_t key);

  const TelemetryBoard& board_;
  OutboxCounts& counts_;
  std::map<std::uint16_t, Key> keys_;
  std::deque<std::uint16_t> waiting_;
};

}  // namespace warren::mesh
