// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <doctest/doctest.h>

#include "proto/framing.hpp"
#include "tests/daemon/frames.hpp"
#include "tests/daemon/running_daemon.hpp"
#include "tests/daemon/test_client.hpp"

namespace warren {

inline Config quick_ticks() {
  Config config;
  config.layer.tick_s = 0.1;
  config.layer.flush_after_s = 0.1;
  return config;
}

// Of a wall; each from a place of its own.
inline void take_scan(const RunningDaemon& daemon, std::uint64_t sequence) {
  TestClient client = greeted_client(daemon.ingest_socket());
  auto request = scan_request(sequence, 1024);
  const double y_m = -0.7 * static_cast<double>(sequence - 1);
  request.mutable_scan()->mutable_t_map_base()->mutable_translation()->set_y(y_m);
  REQUIRE(client.write(framed(request.SerializeAsString()) + payload_of(wall_points(1024))));
  REQUIRE(client.read_receipt().outcome() == ingest::ScanReceipt::TAKEN);
}

// Asks until the scan's tick and the flush after it have been: bounded by the client's patience.
inline void wait_until_published(const RunningDaemon& daemon) {
  for (int asked = 0; asked < 100'000; ++asked) {
    const control::Publishing now = daemon.status().publishing();
    if (now.revision() > 0 && now.blocks_held_back() == 0) return;
  }
  FAIL("nothing was published");
}

// A daemon with short ticks that has published what its first scan showed.
class MappedDaemon : public RunningDaemon {
 public:
  MappedDaemon() : RunningDaemon(quick_ticks()) {
    take_scan(*this, 1);
    wait_until_published(*this);
  }
};

}  // namespace warren
