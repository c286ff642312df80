// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "transport/flow/sent_packets.hpp"
#include "transport/mesh_time.hpp"

namespace warren::mesh {

// How long packets wait in the link's queue, from the delay one way (the receiver's clock minus
// ours: only changes mean something) against the least of the last 10 to 20 s. Round trips bound
// it, so that a step of either clock does no harm.
class QueueDelay {
 public:
  // rate: of the link as far as known, IP bytes/s: long packets take longer without any queue.
  void on_sample(MeshTime now, const AckReport::Largest& sample, double rate);

  // The least of the latest samples: what stands, without jitter. Zero if nothing is known.
  Duration standing() const { return standing_; }
  // How much samples differ from one to the next, and their time apart.
  Duration jitter() const { return jitter_; }
  Duration interval() const { return interval_; }
  std::optional<Duration> least_rtt() const;
  // When a sample last found (nearly) no queue.
  MeshTime last_empty() const { return last_empty_; }

 private:
  struct Least {
    Duration value = Duration::max();
    std::size_t ip_bytes = 0;
    double rate = 0.0;
  };
  // Two halves of a window that moves on.
  struct LeastOfWindow {
    Least older, newer;
    const Least& get() const { return older.value < newer.value ? older : newer; }
  };
  struct Sample {
    MeshTime time;
    Duration queue{};
  };
  static constexpr std::size_t kSamples = 16;

  void move_window(MeshTime now);
  Duration unwrap(MeshTime sent, std::uint32_t arrived_us);
  void update_standing(MeshTime now, Duration queue);

  std::optional<std::uint32_t> last_difference_;
  std::int64_t one_way_us_ = 0;
  LeastOfWindow one_way_, round_trip_;
  MeshTime window_start_{};
  int steps_ = 0;  // samples in a row whose delay one way contradicts the round trip
  std::array<Sample, kSamples> samples_{};
  std::size_t count_ = 0;
  Duration standing_{};
  Duration jitter_{};
  Duration interval_{};
  MeshTime last_empty_{};
};

}  // namespace warren::mesh
