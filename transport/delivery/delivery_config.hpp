// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

struct UrgentConfig {
  int copies = 3;  // sent in any case, unless acknowledged
  Duration spacing = std::chrono::milliseconds(15);
  // Afterwards, while unacknowledged, one each round trip, but not more often than this.
  Duration repeat_min = std::chrono::milliseconds(60);
  // Then it is stale and dropped: what must hold through a blackout is a parcel.
  Duration time_limit = std::chrono::seconds(2);
  std::size_t unacknowledged_max = 128;  // then the oldest is dropped
};

struct ParcelConfig {
  std::size_t unfinished_max = 1024;        // per peer and direction
  std::size_t sent_bytes_max = 16'000'000;  // unfinished ones to one peer
  // Unfinished ones from one peer; its last ParcelFrame::kBytesMax are for the control class. The
  // sender begins no parcel beyond it, so it should be the same in the whole fleet.
  std::size_t received_bytes_max = 4'000'000;
  // Everything is acknowledged but the receipt does not come: ask this often.
  Duration ask_after = std::chrono::seconds(2);
};

struct DeliveryConfig {
  UrgentConfig urgent;
  ParcelConfig parcel;
};

}  // namespace warren::mesh
