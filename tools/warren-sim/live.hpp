// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/warren-replay/replay.hpp"
#include "tools/world/simulation.hpp"

namespace warren::world {

struct LiveOptions {
  std::vector<std::string> sockets;  // one per robot, in order
  std::string sensor;                // empty: each daemon's first
  std::uint64_t frame_epoch = 1;
  bool real_time = true;  // else as fast as the daemons take the scans
};

// Lets all robots measure at once, each into the ingest socket of its own daemon, each on a thread
// of its own. Calls progress, from one thread at a time, with the sums over all robots. The result
// sums up all robots; its error is the first that a robot met.
tl::expected<ReplaySummary, std::string> run_live(const Simulation& simulation,
                                                  const LiveOptions& options,
                                                  const Replay::Progress& progress,
                                                  const std::atomic<bool>& stop);

}  // namespace warren::world
