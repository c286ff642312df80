// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/flow/link_quality.hpp"
#include "transport/flow/rate_controller.hpp"
#include "transport/flow/received_packets.hpp"
#include "transport/flow/sent_packets.hpp"
#include "transport/flow/ticket.hpp"
#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

// All that is to be known about the traffic with one peer: what was sent and what became of it,
// what came and must be acknowledged, how fast the link is. One object per peer and boot of it.
//
// Its owner, in turn: tells what arrives; sends an acknowledgement when ack_due(); asks the
// NodePacer whose turn it is, fills a packet of at most packet_bytes() if may_send(), and tells
// on_sent(). At next_time() it calls on_time().
class Flow {
 public:
  struct Sent {
    std::uint64_t number = 0;  // rises by one with each packet to the peer, of whatever kind
    std::size_t ip_bytes = 0;  // headers included
    bool wants_ack = false;    // false: only an acknowledgement, a beacon's answer
    bool backlogged = false;   // NodePacer::on_sent() said so: the interface had no rest before it
    bool repeat = false;       // resends what is under way already
    std::vector<Ticket> tickets;
  };
  // A ticket told lost may come back acknowledged later: it was only late.
  struct Outcome {
    std::vector<Ticket> acked;
    std::vector<Ticket> lost;
  };

  explicit Flow(const RateController::Config& config);

  void on_sent(MeshTime now, Sent sent);
  // Precondition: the packet was authentic and new.
  void on_received(MeshTime now, const ReceivedPackets::Packet& packet);
  Outcome on_ack(MeshTime now, const AckFrame& ack);
  // Anything else that shows the peer in reach, as its beacon: after a silence, sending starts
  // again without waiting.
  void on_heard(MeshTime now);
  Outcome on_time(MeshTime now);
  // The peer restarted or is forgotten: all that is in flight is lost.
  Outcome abandon();
  // Another interface or address: rate, round trip and queue begin anew.
  void on_path_changed(MeshTime now);
  // When on_time() has something to do, or an acknowledgement is due, or may_send() may turn true.
  MeshTime next_time() const;

  // Room in flight for a packet that wants an acknowledgement. What carries only an acknowledgement
  // need not ask.
  bool may_send(MeshTime now) const;
  // The same for what does not wait its turn, answers and urgent messages: false only if much more
  // than may_send() allows is in flight already.
  bool may_send_at_once(MeshTime now) const;
  bool ack_due(MeshTime now) const { return received_.due(now); }
  bool ack_pending() const { return received_.pending(); }
  std::optional<AckFrame> take_ack(MeshTime now) { return received_.take_ack(now); }

  // What the NodePacer charges airtime by, IP bytes/s.
  double pace() const { return rate_.pace(); }
  // Proposed size of a full packet, IP headers included.
  std::size_t packet_bytes() const { return rate_.packet_bytes(); }
  LinkQuality quality() const;

  // For idle slots: the tickets of the oldest packet in flight that is worth sending once more,
  // as far as the budget of repeats allows. Send it with Sent::repeat.
  std::optional<std::vector<Ticket>> take_repeat(MeshTime now);

  std::size_t memory_bytes() const;

 private:
  MeshTime silence_time() const;
  Duration probe_period() const;
  std::size_t in_flight_max(MeshTime now) const;
  MeshTime room_time() const;

  ReceivedPackets received_;
  SentPackets sent_;
  RateController rate_;
  std::uint64_t next_number_ = 0;
  MeshTime last_time_{};  // told by on_time()
  MeshTime last_sent_{};
  Duration own_ahead_{};      // of what was sent, the airtime that was to come at last_sent_
  MeshTime last_progress_{};  // an acknowledgement came, or the first packet went out
  MeshTime last_probe_{};
  bool silent_ = false;        // nothing is acknowledged: only single packets go out
  double repeat_bytes_ = 0.0;  // still allowed
};

}  // namespace warren::mesh
