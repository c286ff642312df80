// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "transport/delivery/inbox.hpp"
#include "transport/delivery/outbox.hpp"
#include "transport/delivery/send_class.hpp"
#include "transport/delivery/token_bucket.hpp"
#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Shares of the bytes sent to one peer. What parcels, fresh and backlog do not use goes to the
// next; caps are never exceeded.
struct SchedulerConfig {
  double control_cap = 0.10;  // of what is said about parcels
  double telemetry_cap = 0.20;
  double fresh_share = 0.20;  // at least, when there is something
  double backlog_share = 0.10;
  // What the caps may save up, at least so many bytes.
  Duration burst = std::chrono::milliseconds(250);
  double burst_bytes_min = 2200.0;
  // A map packet is not asked for in less room than this, or than three quarters of the packet,
  // or than it needs.
  std::size_t map_room_min = 512;
};

// A map packet of exactly the class asked for, at most the limit.
struct PulledMap {
  std::uint64_t ticket = 0;
  std::vector<std::uint8_t> bytes;
};
using PullMap = std::function<std::optional<PulledMap>(MapClass wanted, std::size_t limit)>;

// What is known of the path at this moment.
struct SendState {
  MeshTime now;
  double rate_bytes_s = 0.0;       // of the pacer, for this peer
  Duration rtt{};                  // zero: unknown
  std::size_t overhead_bytes = 0;  // of a packet, around the frames: IP, UDP, envelope
  // Room of the largest packet that the path carries, though such of now may be smaller: telemetry
  // that needs it gets it, in a packet of its own.
  std::size_t room_max = 0;
  // The map source has nothing that is smaller, ever. It is not asked in less room; like telemetry
  // it gets what it needs in a packet of its own. Beyond room_max: not at all.
  std::size_t map_bytes_min = 1;

  bool map_fits() const { return map_bytes_min + MapFrame::kOverhead <= room_max; }
};

struct FilledPacket {
  std::vector<Frame> frames;
  std::vector<Ticket> tickets;
  std::size_t bytes = 0;                                // encoded
  std::array<std::size_t, kSendClasses> class_bytes{};  // by SendClass

  void add(OutgoingFrame&& sent, SendClass send_class);
  void add(Frame&& frame, SendClass send_class);  // without a ticket
};

// Chooses what goes into the next packet to one peer: urgent, control, telemetry as long as its
// share lasts, then parcels, fresh or backlog, whose guaranteed share is due first. The choice is
// made packet by packet, so nothing waits for more than the packet on the air.
class Scheduler {
 public:
  explicit Scheduler(const SchedulerConfig& config = {});

  // Appends to `packet`. What the caller has put there (acknowledgements and the like) is counted
  // in its `bytes` and `class_bytes`. `room` is of the whole content; one large telemetry value
  // alone, or a map packet alone, may go beyond, up to SendState::room_max. Nothing is appended
  // only if next_due() lies ahead, or for want of room.
  void fill(const SendState& state, std::size_t room, Outbox& outbox, Inbox& inbox,
            const PullMap& pull, FilledPacket& packet);
  // Urgent messages only: for when the pacer has no room for more.
  void fill_urgent(const SendState& state, std::size_t room, Outbox& outbox, FilledPacket& packet);
  // The source has something again: until then a class that had nothing is not asked.
  void wake() { source_empty_ = {}; }
  // When fill() has something, the pacer aside, without anything else happening: the distant past
  // if it has now, at once if the map source was not asked yet.
  MeshTime next_due(const SendState& state, const Outbox& outbox, const Inbox& inbox);

 private:
  struct Filling;
  void refill(const SendState& state);
  void fill_small(Filling& filling);
  void fill_telemetry(Filling& filling);
  void fill_bulk(Filling& filling);
  bool fill_map(Filling& filling, MapClass wanted);
  std::optional<MapClass> owed(std::size_t room) const;
  void account(const Filling& filling);

  SchedulerConfig config_;
  TokenBucket control_;
  TokenBucket telemetry_;
  std::array<double, 2> credit_{};      // bytes owed to fresh, backlog
  std::array<bool, 2> source_empty_{};  // fresh, backlog: had nothing when asked
};

}  // namespace warren::mesh
