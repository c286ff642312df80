// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "transport/mesh_time.hpp"

namespace warren::mesh {

struct LinkQuality {
  std::optional<Duration> rtt;  // none: not measured yet
  double loss_out = 0.0;        // share of our packets that did not arrive, lately
  double loss_in = 0.0;         // of theirs
  double rate_bit_s = 0.0;      // what the link carries, in IP bytes; 0: not known yet
  Duration queue{};             // delay that our packets find waiting in the link's queue
};

}  // namespace warren::mesh
