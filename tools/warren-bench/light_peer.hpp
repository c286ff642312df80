// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <asio/io_context.hpp>

#include "daemon/fleet/fleet.hpp"
#include "tools/warren-bench/fleet_tape.hpp"

namespace warren {

// A robot without a lidar, a mapping thread, a store, and local sockets: what the fleet thread of a
// daemon does, on any thread, with a tape in place of the self-map. One thread: that of the
// io_context, which must outlive it.
class LightPeer {
 public:
  LightPeer(asio::io_context& io, const FleetConfig& config, TapePlay play);
  LightPeer(const LightPeer&) = delete;
  LightPeer& operator=(const LightPeer&) = delete;

  void start() { mesh_.start(); }
  void stop() { mesh_.stop(); }
  // Publishes the next tick of the tape.
  void tick();
  // Publishes what the sender rules hold back.
  void flush();

  struct Progress {
    std::size_t neighbours_up = 0;
    std::size_t have_all = 0;       // of all that was published
    std::size_t digests_equal = 0;  // and said that they have the same
  };
  Progress progress();
  std::uint64_t voxels_published() const;
  // IP bytes with their UDP headers.
  std::uint64_t bytes_sent();

 private:
  NoStore store_;
  TapePlay play_;
  FleetMap map_;
  FleetMesh mesh_;
};

}  // namespace warren
