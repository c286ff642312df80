// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "transport/mesh_time.hpp"

namespace warren {

// Of one direction between two stations. A group packet counts for each that might hear it.
// offered = every drop + what was sent and arrived, duplicates left out, and what is on its way.
struct LinkCounts {
  std::uint64_t offered_packets = 0;
  std::uint64_t offered_bytes = 0;
  std::uint64_t delivered_packets = 0;  // duplicates included
  std::uint64_t delivered_bytes = 0;
  std::uint64_t dropped_too_large = 0;
  std::uint64_t dropped_queue_full = 0;
  std::uint64_t dropped_blackout = 0;
  std::uint64_t dropped_loss = 0;
  std::uint64_t dropped_burst = 0;
  std::uint64_t dropped_pattern = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t corrupted = 0;
  std::uint64_t reordered = 0;
  friend bool operator==(const LinkCounts&, const LinkCounts&) = default;
};

// What a station put on the air, each group packet once.
struct StationCounts {
  std::uint64_t sent_packets = 0;
  std::uint64_t sent_bytes = 0;
  Duration queue_time_max{};  // the longest that a packet waited
};

}  // namespace warren
