// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/link/capacity.hpp"
#include "transport/mesh_time.hpp"

namespace warren {

// Two-state loss (Gilbert 1960): all is lost in the bad state, nothing in the good one.
struct BurstLoss {
  double share = 0.0;         // of all packets, in the long run; below 1
  double mean_packets = 1.0;  // of a burst; at least 1
};

// From `from` up to, not including, `until`, since the link's start.
struct Blackout {
  Duration from{};
  Duration until{};
};

// Which packets a recording lost; it starts over at its end.
struct LossPattern {
  std::vector<bool> lost;
  // How long each entry holds; 0: one entry per packet.
  Duration slot{};
};

// From `at` on until the next step; what is not given stays as the config says.
struct ChannelStep {
  Duration at{};
  std::optional<double> loss;
  std::optional<Duration> delay;
};

// One direction between two stations. Everything may be combined; all that can be lost is lost
// after it took its airtime, as by radio.
struct LinkConfig {
  Capacity capacity;                    // default: no limit
  std::size_t mtu_bytes = 65'535;       // larger ones are dropped before they are queued
  Duration delay{};                     // of propagation
  Duration jitter{};                    // uniform in [delay - jitter, delay + jitter], never < 0
  bool jitter_reorders = false;         // or those behind wait for the late one
  double loss = 0.0;                    // independent, of each packet
  std::optional<BurstLoss> burst_loss;  // besides
  LossPattern loss_pattern;             // besides
  double reorder = 0.0;                 // share of packets that come later than their successors
  Duration reorder_by{};                // by so much
  double duplicate = 0.0;               // share of packets that arrive twice
  double corrupt = 0.0;                 // share of packets in which 1 to 8 bits are flipped
  std::vector<Blackout> blackouts;      // rising, not overlapping
  std::vector<ChannelStep> steps;       // rising times
};

// Of one station, before its airtime; a packet that would pass any limit is dropped.
struct QueueLimit {
  std::size_t packets = 1000;
  std::size_t bytes = SIZE_MAX;
  // How long a new packet would wait for those before it, if nobody else sent.
  Duration time = Duration::max();
};

}  // namespace warren
