// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <queue>
#include <random>
#include <utility>
#include <vector>

#include "transport/mesh_time.hpp"

namespace warren::mesh {

// One direction of a link in virtual time: a queue before a transmitter, then the air, where
// packets are lost after they used it.
struct BottleneckConfig {
  // From each time on this many IP bits/s; the first entry at zero.
  std::vector<std::pair<Duration, double>> rate_bit_s = {{Duration{0}, 1e6}};
  std::size_t buffer_packets = 1'000'000;  // waiting, not counting the one being sent
  Duration buffer_delay = std::chrono::milliseconds{1000};
  Duration delay = std::chrono::milliseconds{25};
  std::pair<Duration, Duration> longer{};  // from then on, by so much
  Duration jitter{};                       // uniform from zero; packets may overtake
  double loss = 0.0;
  double burst_packets = 0.0;  // mean length of a burst (Gilbert-Elliott); 0: independent losses
  std::pair<Duration, Duration> blackout{};  // from, to
};

struct BottleneckPacket {
  std::size_t flow = 0;
  std::size_t ip_bytes = 0;
  std::uint64_t id = 0;  // the sender's, to find its content
};

class Bottleneck {
 public:
  Bottleneck(const BottleneckConfig& config, std::uint64_t seed) : config_(config), random_(seed) {}

  void send(MeshTime now, const BottleneckPacket& packet);
  MeshTime next_arrival() const { return air_.empty() ? kNever : air_.top().arrives; }
  BottleneckPacket take_arrival();

  // How long a packet sent now would wait.
  Duration queue(MeshTime now) const;
  std::size_t bytes_offered() const { return bytes_offered_; }
  std::size_t packets_overflowed() const { return packets_overflowed_; }

 private:
  struct InAir {
    MeshTime arrives;
    std::uint64_t order = 0;
    BottleneckPacket packet;
    bool operator<(const InAir& other) const {
      return std::pair(arrives, order) > std::pair(other.arrives, other.order);
    }
  };
  double rate_at(MeshTime time) const;
  MeshTime transmitted(MeshTime from, double bits) const;
  bool lost_on_air(MeshTime now);
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  BottleneckConfig config_;
  std::mt19937_64 random_;
  std::deque<MeshTime> departures_;  // of the packets in the queue, ends of their sending
  MeshTime free_at_{};
  std::priority_queue<InAir> air_;
  std::uint64_t order_ = 0;
  bool in_burst_ = false;
  std::size_t bytes_offered_ = 0;
  std::size_t packets_overflowed_ = 0;
};

}  // namespace warren::mesh
