// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "core/layer/claim.hpp"
#include "daemon/fleet/fleet_map.hpp"

namespace warren {

// What a score says of the layer: it lies where it belongs, lies askew, or misleads.
enum class ConflictLevel : std::uint8_t { kAligned, kAskew, kMisleading };
ConflictLevel level_of(double score);

// How far the layers of others contradict what this node measured: of their obstacles where it
// knows something itself, the share that it knows as free. Aligned maps have about 0.02; 0.2
// m aside 0.14, half a metre 0.40. Looks at a few regions of one layer at a time, so a score is
// that of the last whole round, some seconds to minutes old. It changes nothing but what the
// merge-map has cached.
class ConflictWatch {
 public:
  static constexpr std::size_t kRegionsPerTick = 4;  // one at rest takes some milliseconds
  static constexpr std::uint64_t kVoxelsMin = 500;   // fewer prove nothing
  static constexpr double kAlign = 0.10;             // from here on the layer lies askew
  static constexpr double kQuarantine = 0.25;        // from here on it misleads

  // The layer whose round ended with this call, if one did and there is a score.
  std::optional<LayerId> advance(FleetMap& map);
  // Nothing: no round has ended yet, or both know too little of the same places.
  std::optional<double> score(const LayerId& layer) const;

 private:
  struct Round {
    std::uint64_t known = 0;
    std::uint64_t free = 0;
  };
  // Where a round may go on; the end: it is done.
  BlockOrdinal look_at(FleetMap& map, const Replica& layer);
  const Replica* next_layer(const FleetMap& map) const;

  std::optional<LayerId> at_;  // the layer under way
  BlockOrdinal next_ = 0;
  Round round_;
  std::map<LayerId, double> scores_;
};

}  // namespace warren
