// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daemon/fleet/own_layer.hpp"
#include "daemon/mapper/layered_map.hpp"

namespace warren {

// The own layers as published, in numbers.
struct PublishingReport {
  std::uint32_t layers = 0;
  DiffTraffic traffic;  // of all layers
  std::uint64_t blocks_held_back = 0;
  std::size_t memory_bytes = 0;
  std::uint64_t ticks = 0;
  std::uint64_t ticks_late = 0;  // the one before was not done yet
  struct Current {
    LayerId id;
    Revision revision;
    Hash digest{};
  };
  std::optional<Current> current;  // nothing before the first scan
};

// What a copy of the current own layer lacks.
struct LayerDiff {
  LayerId id;
  double resolution_m = 0.0;
  Revision revision;
  std::vector<std::vector<std::uint8_t>> packets;
  BlockOrdinal next_key = kOrdinalEnd;  // where to go on; the end: nothing is missing above
};

struct FleetMapConfig {
  std::uint32_t origin = 0;  // of the own layers
  double resolution_m = 0.1;
  PublishingConfig publishing;
};

// All layers that this node holds. One thread: the fleet's.
class FleetMap {
 public:
  // More than one answer may hold; a follower asks again.
  static constexpr std::size_t kDiffBytesMax = 512 * 1024;

  // Draws incarnations of layers: 64 random bits each time.
  using DrawIncarnation = std::function<std::uint64_t()>;
  FleetMap(const FleetMapConfig& config, DrawIncarnation draw_incarnation)
      : config_(config), draw_incarnation_(std::move(draw_incarnation)) {}

  // One tick of all own layers.
  void tick(std::span<const LayerChanges> changes);
  // Publishes what the sender rules hold back.
  void flush();

  PublishingReport report() const;
  // From the revision that the copy holds at `keys` on. Nothing before the first scan.
  std::optional<LayerDiff> diff(const KeyInterval& keys, Revision from) const;

 private:
  OwnLayer& own_layer(std::uint32_t number);
  const Replica* current() const;

  FleetMapConfig config_;
  DrawIncarnation draw_incarnation_;
  std::map<std::uint32_t, OwnLayer> own_;  // the last is the current one
  std::uint64_t ticks_ = 0;
};

}  // namespace warren
