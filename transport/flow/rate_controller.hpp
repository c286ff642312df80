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

namespace warren::mesh {

// How fast to send to one peer. Loss is not congestion; delay that grows is. While a small queue
// stands in the link, the spacing of arrivals is the link's rate; while none does, the rate is
// raised as long as arrivals follow. Why so: docs/adr/0002-rate-control.md.
class RateController {
 public:
  struct Config {
    std::size_t packet_bytes_max = 1428;  // IP packet
    std::size_t packet_bytes_min = 300;
    std::optional<double> ceiling_bit_s;
  };

  explicit RateController(const Config& config);

  // next: the number of the next packet to send.
  void on_ack(MeshTime now, const AckFrame& ack, const AckReport& report, std::uint64_t next);
  // After a silence the old rate is taken up with care.
  void on_silence();
  // The path is another: all is unknown again.
  void forget_path(std::uint64_t next);

  double pace() const;  // IP bytes/s
  bool known() const { return known_; }
  double rate() const { return rate_; }  // what the link carries, IP bytes/s
  std::size_t in_flight_max() const;     // IP bytes
  MeshTime paused_until() const { return paused_until_; }
  std::size_t packet_bytes() const;
  Duration queue() const { return queue_.standing(); }

 private:
  // A stretch of packets sent at one gain; judged when enough that were sent in it arrived.
  struct Round {
    std::uint64_t first = 0;
    std::optional<ArrivalRate::Mark> from;  // its first packet arrived
    bool queued = false;                    // a queue showed
  };

  void skip_pauses(const AckReport& report);
  void judge_first_flight(const AckReport& report, std::uint64_t next);
  void begin_round(std::uint64_t next);
  void give_up_round(MeshTime now, std::uint64_t next);
  void end_round(MeshTime now, const ArrivalRate::Measure& seen);
  void stop_search();
  void wait_at_plateau(MeshTime now);
  void watch_round(MeshTime now, const AckReport& report, std::uint64_t next);
  void follow_arrivals(MeshTime now);
  void fall_fast(MeshTime now, std::uint64_t next);
  void empty_queue_sometimes(MeshTime now);
  void set_rate(double rate);
  Duration target() const;
  bool queue_shows() const;
  double uncertainty(const ArrivalRate::Measure& seen) const;
  Duration round_trip() const {
    return queue_.least_rtt().value_or(std::chrono::milliseconds{100});
  }

  Config config_;
  ArrivalRate arrivals_;
  QueueDelay queue_;
  Round round_;
  double rate_;
  double confirmed_rate_ = 0.0;  // measured while a queue stood
  bool known_ = false;           // rate_ was measured
  bool starting_ = true;
  double gain_;  // above 1: looks for more
  double loss_ = 0.0;
  double start_bytes_ = 0.0;    // acknowledged while starting
  bool through_queue_ = false;  // looks for more though a queue shows
  MeshTime queue_grew_{};       // it was near its target, or this was tried
  int patience_ = 0;            // rounds until it looks for more again
  MeshTime plateau_since_{};
  MeshTime queued_since_{};
  MeshTime last_followed_{};
  MeshTime paused_until_{};
  MeshTime last_pause_{};
  MeshTime last_empty_{};
};

}  // namespace warren::mesh
