// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/layer/claim.hpp"
#include "daemon/control/layer_shift.hpp"

namespace warren {

// Requests that concern the whole fleet. Nodes are called by their names.

struct MessageSendOrder {
  std::string to;  // empty: everybody
  bool urgent = false;
  std::string key;  // of one key and addressee only the latest counts; empty: all do
  std::vector<std::uint8_t> bytes;
};
// What has come since?
struct MessageWatchQuestion {
  std::uint64_t inbox = 0;  // that the cursor belongs to; 0: none yet
  std::uint64_t after = 0;
};
struct FleetOrder {
  enum class What : std::uint8_t { kRetract, kRestore, kClear, kAlign };
  What what = What::kRetract;
  std::string node;              // all its layers; of an alignment the newest
  std::optional<LayerId> layer;  // or this one alone
  LayerShift shift;              // with kAlign; in place of an earlier one
};
struct TrajectoryQuestion {
  std::string node;
  std::int64_t after_us = 0;  // points later than this
};
// How would the node's newest layer have to be aligned to fit another?
struct AlignEstimateQuestion {
  std::string node;
  std::string against;  // another node's newest layer; empty: the own one
};

}  // namespace warren
