// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/layer/replica.hpp"
#include "daemon/replication/map_message.hpp"

namespace warren::replication {

// What one member wants of one layer that we hold, what it is known to hold, and what is on its way
// to it. Nothing is queued: each packet is made of the layer as it is when there is room to send.
//
// Keys where the member is known to hold at least `goal` are swept: what changes there is fresh,
// and all of them are levelled by each packet. The others are backlog: hot regions first, then in
// order, each key once. A layer that is small when it begins to be wanted, as after its writer's
// first scans, is fresh as a whole: all who want it then can be told at once.
class Subscription {
 public:
  // On its way at once: if any of them were lost, the member's holdings must still have room.
  static constexpr std::size_t kIntervalsAndPacketsMax = 60;
  // Told lost, and remembered in case that it was only late.
  static constexpr std::size_t kLateMax = 64;
  // Some 15 full packets: so few that a member's holdings hardly run out of room by losses.
  static constexpr std::uint64_t kSmall_voxels = 250'000;
  // So many revisions apart, swept keys get packets of their own.
  static constexpr std::uint32_t kLevelWithin = 4;

  // False: an older wish than the last, which stands.
  bool on_wish(const Wish& wish, const Replica& layer);
  bool wanted() const { return wanted_; }
  bool wants_everything() const { return wanted_ && keys_.is_everything(); }
  // After a silence: what it lacks now is backlog.
  void raise_goal(const Replica& layer);

  // The next packet of each class, at most `limit` bytes, or nothing to send now. Tell on_sent().
  std::optional<DiffPacket> next_fresh(const Replica& layer, std::size_t limit) const;
  std::optional<DiffPacket> next_backlog(const Replica& layer, std::size_t limit);

  void on_sent(std::uint64_t ticket, const Claim& claim);
  void on_acknowledged(std::uint64_t ticket);
  void on_lost(std::uint64_t ticket);
  // Told to all who hear the group, and taken for delivered: who missed it says so.
  void on_broadcast(const Claim& claim);

  // It holds at least this, and no packet to it went astray.
  const Holdings& believed() const { return believed_; }
  // And this, if nothing under way is lost.
  const Holdings& assumed() const { return assumed_; }
  Revision goal() const { return goal_; }
  std::size_t under_way() const { return flying_; }
  std::size_t memory_bytes() const { return sizeof(*this) + packets_.size() * 96; }

  // Keys that lack about the same since `from`.
  struct Run {
    KeyInterval keys;
    Revision from;
  };
  // What next_fresh() would begin with, of one that wants everything.
  std::optional<Run> next_run(const Replica& layer) const {
    return wants_everything() ? fresh_run(layer, {}) : std::nullopt;
  }
  // For the intervals of any one claim more.
  bool has_room() const {
    return std::max(believed_.intervals().size(), assumed_.intervals().size()) + 2 <=
           Holdings::kIntervalsMax;
  }

 private:
  struct Packet {
    Claim claim;
    bool lost = false;
  };
  std::optional<Run> fresh_run(const Replica& layer, const KeyInterval& wanted) const;
  std::optional<Run> backlog_run(const Replica& layer, const KeyInterval& within) const;
  std::optional<DiffPacket> encode(const Replica& layer, const Run& run, std::size_t limit) const;
  void plan_parts(const Replica& layer);
  void assume_anew();

  bool wanted_ = false;
  std::uint64_t wish_ = 0;  // number of the last one
  KeySet keys_;
  Revision goal_{1};
  Holdings believed_;
  Holdings assumed_;
  std::map<std::uint64_t, Packet> packets_;  // by ticket
  std::size_t flying_ = 0;                   // of these not lost
  std::vector<KeyInterval> parts_;           // in the order of sending; empty: to be planned
  Revision planned_at_;                      // what we held at most when they were planned
};

}  // namespace warren::replication
