// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "bottleneck.hpp"
#include "transport/flow/flow.hpp"
#include "transport/flow/node_pacer.hpp"

namespace warren::mesh {

struct TransferConfig {
  BottleneckConfig there, back;
  std::uint64_t seed = 1;
  // Of each flow: when it starts; bytes that it has to bring over (0: endless).
  struct Load {
    Duration start{};
    std::size_t app_bytes = 0;
    double app_bit_s = 0.0;  // offered not faster than this; 0: all at once
    Duration slow_from{};    // since then, after the start
  };
  std::vector<Load> flows = {{}};
  // What the receivers' clocks show more than ours from this time on.
  std::vector<std::pair<Duration, Duration>> clock_steps;
  double clock_drift = 0.0;
  Duration until = std::chrono::seconds{600};
};

// Flows between pairs of nodes over one link, each with a sender that has something to send and
// resends what is lost.
class Transfer {
 public:
  explicit Transfer(const TransferConfig& config);
  // Until all is over, or the time is up.
  void run();
  void run_until(Duration until);

  static constexpr std::size_t kOverhead = 28 + 32 + 3;

  MeshTime now() const { return now_; }
  // When the last byte of the flow arrived; none: it did not.
  std::optional<MeshTime> finished(std::size_t flow) const { return sides_[flow].finished; }
  std::size_t app_bytes_arrived(std::size_t flow) const { return sides_[flow].bytes_arrived; }
  std::size_t data_bytes_sent(std::size_t flow) const { return sides_[flow].bytes_sent; }
  std::uint64_t packets_sent(std::size_t flow) const { return sides_[flow].next_number; }
  std::size_t ack_bytes_sent() const { return ack_bytes_; }
  std::size_t resent_in_vain(std::size_t flow) const { return sides_[flow].resent_in_vain; }
  const Flow& sender(std::size_t flow) const { return *sides_[flow].sender; }
  const Bottleneck& link() const { return there_; }
  // Of the packets that arrived: how long they waited in the queue, in order of arrival.
  struct Waited {
    MeshTime at;
    Duration queue{};
  };
  const std::vector<Waited>& waited() const { return waited_; }
  std::optional<MeshTime> first_arrival_after(Duration time, std::size_t flow) const;

 private:
  struct Side {
    TransferConfig::Load load;
    std::unique_ptr<Flow> sender, receiver;
    NodePacer pacer{std::nullopt};
    std::uint64_t next_number = 0, next_chunk = 0, next_ack = 0;
    std::size_t bytes_left = 0;
    double bytes_offered = 0.0;                      // of a slow source, so far
    std::map<std::uint64_t, std::size_t> under_way;  // chunks not acknowledged: bytes
    std::deque<std::uint64_t> resend;
    std::vector<bool> arrived;  // by chunk
    std::size_t bytes_arrived = 0, bytes_sent = 0, resent_in_vain = 0;
    std::optional<MeshTime> finished;
    std::vector<MeshTime> arrivals;
  };
  struct Content {
    std::uint64_t number = 0;
    std::uint64_t chunk = 0;
    std::size_t app_bytes = 0;
    Duration queue{};
  };

  MeshTime next_event() const;
  void step();
  bool started(const Side& side) const { return now_ >= MeshTime{side.load.start}; }
  std::size_t available(const Side& side) const;
  bool may_offer(const Side& side) const;
  void send_data(std::size_t flow);
  bool send_one(std::size_t flow, Side& side);
  void transmit(std::size_t flow, Side& side, std::uint64_t chunk, std::size_t bytes, bool repeat);
  void send_acks(std::size_t flow);
  void settle(Side& side, const Flow::Outcome& outcome);
  void arrive_there(const BottleneckPacket& packet);
  void arrive_back(const BottleneckPacket& packet);
  std::uint32_t clock_difference() const;

  TransferConfig config_;
  Bottleneck there_, back_;
  std::vector<Side> sides_;
  std::map<std::uint64_t, Content> contents_;
  std::map<std::uint64_t, AckFrame> acks_;
  std::uint64_t next_id_ = 0;
  MeshTime now_{};
  std::size_t ack_bytes_ = 0;
  std::vector<Waited> waited_;
};

}  // namespace warren::mesh
