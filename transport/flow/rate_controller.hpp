// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "transport/flow/arrival_rate.hpp"
#include "transport/flow/queue_delay.hpp"
#include "transport/flow/sent_packets.hpp"
#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"

namespace warren {

// How fast to send to one peer. Loss is not congestion; delay that grows is. While a small queue
// stands in the link, the spacing of arrivals is the link's rate; while none does, the rate is
// raised as long as arrivals follow. See docs/adr on rate control.
class RateController {
 public:
  struct Config {
    std::size_t packet_bytes_max = 1428;  // IP packet
    std::size_t packet_bytes_min = 300;
    std::optional<double> ceiling_bit_s;
  };

  explicit RateController(const Config& config);

  void on_sent(MeshTime now, std::uint64_t number, std::size_t ip_bytes, bool backlogged);
  void on_ack(MeshTime now, const AckFrame& ack, const AckReport& report);
  // Nothing was acknowledged for long while packets were in flight.
  void on_silence(MeshTime now);
  void on_heard(MeshTime now);

  double pace() const;                   // IP bytes/s
  double rate() const { return rate_; }  // what the link carries, IP bytes/s
  std::size_t in_flight_max() const;     // IP bytes
  MeshTime paused_until() const { return paused_until_; }
  std::size_t packet_bytes() const;
  Duration queue() const { return queue_.standing(); }

 private:
  enum class Mode : std::uint8_t { kStart, kSteady };
  // A stretch of packets sent at one pace, judged when one sent after its start was acknowledged.
  struct Round {
    std::uint64_t first = 0;
    bool backlogged = true;  // never short of something to send
    bool queued = false;     // a queue showed
  };

  Config config_;
  ArrivalRate arrivals_;
  QueueDelay queue_;
  Mode mode_ = Mode::kStart;
  Round round_;
  double rate_;
  double gain_;
  MeshTime paused_until_{};
  std::uint64_t next_number_ = 0;
  bool silent_ = false;
};

}  // namespace warren
