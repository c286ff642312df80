// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "tests/fleet/fleet.hpp"

namespace warren::fleet_sim {
namespace {

using replication::Share;
using replication::SharePolicy;

// The highest revision that any of them holds: from each key up to the next.
std::map<BlockOrdinal, Revision> highest_of(const std::vector<const Replica*>& replicas) {
  std::map<BlockOrdinal, Revision> highest;
  for (const Replica* replica : replicas) {
    for (const auto& interval : replica->holdings().intervals()) highest[interval.first] = {};
  }
  for (auto& [key, held] : highest) {
    for (const Replica* replica : replicas) held = std::max(held, replica->holdings().at(key));
  }
  return highest;
}

bool is_near(BlockOrdinal block, const Eigen::Vector3d& position, double radius_m) {
  const BlockKey key = block_key_of(block);
  const double edge_m = kBlockEdge * kDefaultResolution.metres();
  const Eigen::Array3d low = Eigen::Array3d(key.x, key.y, key.z) * edge_m;
  return (low <= position.array() + radius_m).all() &&
         (low + edge_m >= position.array() - radius_m).all();
}

}  // namespace

std::optional<std::string> Fleet::lacking() const {
  std::map<LayerId, std::vector<const Replica*>> replicas;
  for (const FleetNode& node : nodes_) {
    if (!node.replication) continue;
    for (const auto& layer : std::as_const(*node.replication).book().layers()) {
      replicas[layer->id].push_back(&layer->replica());
    }
  }
  for (const auto& [id, of_layer] : replicas) {
    const auto highest = highest_of(of_layer);
    const auto anything = [](const auto& piece) { return piece.second > Revision{}; };
    if (std::none_of(highest.begin(), highest.end(), anything)) continue;
    std::set<Hash> digests;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const SharePolicy share = i < config_.shares.size() ? config_.shares[i] : SharePolicy{};
      if (!nodes_[i].replication || share.share == Share::kNothing) continue;
      const std::string name =
          "layer of " + std::to_string(id.origin) + " at node " + std::to_string(i + 1);
      const auto* const held = std::as_const(*nodes_[i].replication).book().find(id);
      if (held == nullptr) return name + ": not known";
      const Holdings& holdings = held->replica().holdings();
      const bool everything = share.share == Share::kEverything;
      const auto is_behind = [&](const auto& piece) {
        return holdings.at(piece.first) < piece.second;
      };
      const auto lacks = [&](BlockOrdinal block) {
        return is_near(block, position(i), share.radius_m) &&
               is_behind(*std::prev(highest.upper_bound(block)));
      };
      const auto written = history_.written(id);
      if (everything ? std::any_of(highest.begin(), highest.end(), is_behind)
                     : std::any_of(written.begin(), written.end(), lacks)) {
        return name + ": behind";
      }
      if (everything) digests.insert(held->replica().digest().root());
      if (digests.size() > 1) return name + ": differs";
    }
  }
  return std::nullopt;
}

}  // namespace warren::fleet_sim
