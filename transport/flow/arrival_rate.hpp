// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "transport/flow/sent_packets.hpp"
#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

// The rate at which consecutive packets arrive, beside that at which they were sent. Packets lost
// between others count for neither, so the figure is right at any random loss, and a queue that
// overflows does not inflate it. Pauses of the sender do not lower it; nothing is measured across
// long ones, because the two sides need not agree on which pair spans them.
class ArrivalRate {
 public:
  struct Measure {
    double arrival_rate = 0.0;  // IP bytes/s, without the time that went to other peers: the
                                // link's rate if a queue stood all the time
    double busy = 0.0;          // share of the time that the sender had no rest
    // Of the pairs between which it had none:
    double pairs = 0.0;
    double bytes = 0.0;    // IP bytes
    double seconds = 0.0;  // from sending to sending, in sum
    double rate = 0.0;     // IP bytes/s: the link's, or else the sender's pace
    double stretch = 1.0;  // arrival spacing / sending spacing: above 1 the link is too slow
  };

  // All that was acknowledged up to some time.
  struct Mark {
    MeshTime time;
    double arrived_bytes = 0.0;
    double arrived_us = 0.0;
    double acked_bytes = 0.0;  // of all packets, paired or not
    double busy_acked_bytes = 0.0;
    AckReport::PairSums sent;
  };

  void on_ack(MeshTime now, const AckFrame& ack, const AckReport& report);
  const Mark& mark() const { return total_; }
  // Of what was acknowledged since then: nothing if no two consecutive packets were.
  std::optional<Measure> since(const Mark& from) const;
  // Of what was acknowledged since a time, or for longer if that was fewer than so many pairs, but
  // nothing from before the earliest.
  std::optional<Measure> since(MeshTime time, double pairs, MeshTime earliest = {}) const;

 private:
  static constexpr std::size_t kMarksMax = 256;
  static constexpr Duration kMarkSpacing = std::chrono::milliseconds{4};

  std::deque<Mark> marks_;  // oldest first
  std::uint32_t last_bytes_ = 0, last_us_ = 0;
  Mark total_;
};

}  // namespace warren::mesh
