// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

// What came from one peer, and when it is to be told so. Acknowledgements are never acknowledged;
// each is whole in itself, so any of them may be lost.
class ReceivedPackets {
 public:
  struct Packet {
    std::uint64_t number = 0;
    std::size_t ip_bytes = 0;
    bool wants_ack = false;
  };

  // Precondition: the number is new (ReplayWindow).
  void on_received(MeshTime now, const Packet& packet);

  // An acknowledgement should go now, even alone; or not before this time: kNever if nothing is
  // to be told.
  bool due(MeshTime now) const { return due_at_ <= now; }
  MeshTime due_at() const { return due_at_; }
  // Something is to be told: an acknowledgement is welcome in a packet that goes anyway.
  bool pending() const { return unacked_ > 0; }
  // Nothing if no packet ever came.
  std::optional<AckFrame> take_ack(MeshTime now);

  // Share of the peer's packets that did not come, lately.
  double loss() const { return loss_; }

 private:
  struct Arrival {
    std::uint64_t number = 0;
    MeshTime time;
    std::size_t ip_bytes = 0;
  };
  static constexpr std::size_t kArrivals = 128;  // a power of two

  void add_number(std::uint64_t number);
  void add_pairs(const Arrival& arrival);
  void measure_loss(std::uint64_t number);
  void measure_rate(MeshTime now, std::size_t ip_bytes);
  void schedule(MeshTime now, bool wants_ack);
  const Arrival* arrival(std::uint64_t number) const;

  struct Range : NumberRange {
    int told = 0;  // in so many acknowledgements since it changed
  };
  std::vector<Range> ranges_;  // highest first, at most AckFrame::kRangesMax
  std::uint32_t acks_ = 0;
  std::array<Arrival, kArrivals> arrivals_{};  // by number modulo kArrivals
  std::uint32_t pair_bytes_ = 0;
  std::uint32_t pair_us_ = 0;

  std::size_t unacked_ = 0;  // wanted an acknowledgement since the last one was sent
  int quick_ = 0;            // so many more are acknowledged quickly
  bool repeat_ = false;      // the last one is sent once more if nothing else comes
  MeshTime due_at_ = kNever;
  MeshTime last_ack_{};
  MeshTime last_arrival_{};
  double rate_ = 0.0;  // IP bytes/s that arrive
  double loss_ = 0.0;
};

}  // namespace warren::mesh
