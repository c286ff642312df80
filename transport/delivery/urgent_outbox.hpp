// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "transport/delivery/delivery_config.hpp"
#include "transport/delivery/delivery_counts.hpp"
#include "transport/delivery/outgoing_frame.hpp"
#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Sends each message in spaced copies until one is acknowledged or the message is stale. They may
// arrive in another order.
class UrgentOutbox {
 public:
  UrgentOutbox(const UrgentConfig& config, OutboxCounts& counts, std::uint32_t first_number = 0)
      : config_(config), counts_(counts), next_number_(first_number) {}

  // Precondition: at most UrgentFrame::kBytesMax.
  void send(MeshTime now, std::span<const std::uint8_t> bytes);
  // The one that is due the longest, if it fits; `rtt` spaces the repetitions after the copies.
  std::optional<OutgoingFrame> next(MeshTime now, std::size_t room, Duration rtt);
  std::optional<OutgoingFrame> again(const UrgentTicket& ticket) const;
  // When next() has something.
  MeshTime next_due() const;
  void on_acked(const UrgentTicket& ticket);
  std::size_t unacknowledged() const { return messages_.size(); }
  std::uint32_t next_number() const { return next_number_; }

 private:
  struct Message {
    std::uint32_t number = 0;
    MeshTime stale_at;
    MeshTime due;
    int copies_sent = 0;
    std::vector<std::uint8_t> bytes;
  };
  void drop_stale(MeshTime now);

  UrgentConfig config_;
  OutboxCounts& counts_;
  std::uint32_t next_number_;
  std::deque<Message> messages_;  // by number
};

}  // namespace warren::mesh
