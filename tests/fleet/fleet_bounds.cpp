// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "tests/fleet/fleet.hpp"

namespace warren::fleet_sim {

// A node needs so much for itself and its members, and for each block that was ever written.
constexpr std::size_t kNodeBytes = 250'000;
constexpr std::size_t kBlockBytes = 4'000;

std::optional<std::string> Fleet::beyond_bounds() const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const std::string at = " at node " + std::to_string(i + 1);
    for (const auto& [id, stored] : nodes_[i].disk.layers()) {
      if (stored.blocks.size() > history_.blocks(id)) return "blocks that never were" + at;
    }
    if (!nodes_[i].replication) continue;
    std::size_t blocks = 0;
    for (const auto& layer : std::as_const(*nodes_[i].replication).book().layers()) {
      blocks += history_.blocks(layer->id);
    }
    const std::size_t bytes = nodes_[i].replication->memory_bytes();
    if (bytes > kNodeBytes + kBlockBytes * blocks) {
      return std::to_string(bytes) + " bytes for " + std::to_string(blocks) + " blocks" + at;
    }
  }
  return std::nullopt;
}

Fleet::Packets Fleet::packets() const {
  Packets packets;
  for (const FleetNode& node : nodes_) {
    if (!node.replication) continue;
    const auto& counts = std::as_const(*node.replication).book().apply_counts();
    packets.applied += counts[static_cast<std::size_t>(ApplyResult::kApplied)];
    packets.duplicate += counts[static_cast<std::size_t>(ApplyResult::kDuplicate)];
  }
  return packets;
}

}  // namespace warren::fleet_sim
