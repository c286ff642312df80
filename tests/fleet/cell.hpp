// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "tests/fleet/fleet.hpp"

namespace warren::fleet_sim {

// One radio channel, one sends at a time; everybody hears everybody, or in a line only the next.
struct Cell {
  std::size_t nodes = 10;
  std::size_t writers = 10;
  double rate_bit_s = 1e6;
  double loss = 0.0;
  bool broadcast = false;
  bool line = false;  // a chain: each hears its neighbours only
  Duration tick = std::chrono::seconds(1);
  Walker::Config walker{.blocks_per_step = 8, .voxels_per_block = 60};
  Duration time = std::chrono::seconds(60);
  std::uint64_t seed = 1;
};

struct CellUse {
  double airtime_share = 0.0;    // of the time measured
  double bytes_per_voxel = 0.0;  // on the air / voxels changed that came to another node
  double copies = 0.0;           // bytes on the air / bytes that would tell each tick once
  double telemetry_share = 0.0;  // of the bytes on the air, by frames
  double fresh_share = 0.0;
  double backlog_share = 0.0;
  double group_share = 0.0;
  double wishes = 0.0;     // because something was lost, per node and minute
  double lag_s_p50 = 0.0;  // of all nodes and layers, once a second
  double lag_s_p95 = 0.0;
};

CellUse measure(const Cell& cell);

}  // namespace warren::fleet_sim
