// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "transport/flow/sent_packets.hpp"
#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"

namespace warren {

// The rate at which consecutive packets arrive beside the rate at which they were sent. Packets
// lost between others count for neither, so the figure is right at any random loss, and a queue
// that overflows does not inflate it.
class ArrivalRate {
 public:
  struct Measure {
    double rate = 0.0;     // IP bytes/s that arrived between consecutive packets
    double stretch = 1.0;  // arrival spacing / sending spacing: above 1 the link is too slow
    double usage = 0.0;    // share of the sending time that the packets were meant to need
    double packets = 0.0;  // how many pairs, about
    Duration span{};
  };

  void on_ack(MeshTime now, const AckFrame& ack, const AckReport& report);
  // Over what arrived in the last span, or more if that was fewer than so many pairs.
  std::optional<Measure> over(Duration span, double packets) const;
  void restart();

 private:
  struct Mark {
    MeshTime time;
    double arrived_bytes = 0.0;
    double arrived_us = 0.0;
    double acked_packets = 0.0;
    AckReport::PairSums sent;
  };
  static constexpr std::size_t kMarksMax = 256;
  std::deque<Mark> marks_;  // oldest first
  std::optional<std::uint32_t> last_bytes_, last_us_;
  Mark now_;
};

}  // namespace warren
