// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "daemon/ingest/messages.hpp"

namespace warren {

// What became of one sensor's scans. received = the sum of the others + those in hand.
struct SensorCounts {
  std::uint64_t received = 0;
  std::uint64_t taken = 0;
  std::uint64_t dropped_overload = 0;
  std::uint64_t dropped_out_of_order = 0;
  std::uint64_t rejected = 0;
};

struct IngestStatus {
  std::uint32_t clients = 0;
  std::map<std::string, SensorCounts> sensors;
  std::array<std::uint64_t, kRefusalCount> refused{};
  std::uint64_t replies_dropped = 0;  // to clients that do not read them
};

}  // namespace warren
