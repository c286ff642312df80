// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "transport/mesh_id.hpp"
#include "transport/mesh_time.hpp"

namespace warren::replication {

// Which blocks of the layers of others a node copies. Poses and logs come in any case.
enum class Share : std::uint8_t { kEverything, kNear, kNothing };

struct SharePolicy {
  Share share = Share::kEverything;
  double radius_m = 50.0;  // with kNear: around this node
};

struct Timers {
  // A layer that goes on changing is announced so often.
  Duration refresh = std::chrono::seconds(30);
  // So long unchanged, it is announced with its digest.
  Duration quiet = std::chrono::seconds(3);
  // Between two announcements of one layer, unless it says something new about the way to it.
  Duration between = std::chrono::seconds(10);
  Duration between_urgent = std::chrono::milliseconds(200);
  // A way to a layer that got longer is told only if it stays so.
  Duration worse_way = std::chrono::seconds(2);
  // The provider has more and sends nothing at all; or sends, but nothing of this layer.
  Duration idle_provider = std::chrono::seconds(2);
  Duration busy_provider = std::chrono::seconds(30);
  // A provider that still did nothing is not asked again for so long.
  Duration penalty = std::chrono::seconds(60);
};

struct LayerLimits {
  std::size_t layers_max = 192;                            // above: no more copies, own ones still
  std::size_t regions_max = 8192;                          // of a copy; each up to 512 blocks
  std::size_t copies_bytes_max = std::size_t{2048} << 20;  // of all copies in memory
};

struct ReplicationConfig {
  MemberId self;
  SharePolicy share;
  LayerLimits layers;
  std::size_t logs_max = 224;  // one per life of a node without its store
  // Interfaces on which fresh packets go to all who hear them; as the endpoint is configured.
  std::vector<bool> group_broadcast;
  Timers timers;
};

// Telemetry keys: from these on, one per layer, one per log.
inline constexpr std::uint16_t kLayerKeys = 0x100;
inline constexpr std::uint16_t kLogKeys = 0x200;

}  // namespace warren::replication
