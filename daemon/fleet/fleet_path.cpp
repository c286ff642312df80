// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet_path.hpp"

#include <algorithm>
#include <map>

#include "daemon/fleet/path_chunk.hpp"

namespace warren {
namespace {

using replication::Replication;

// Where the layers of a node lie, also those that are not copied here.
class Places {
 public:
  Places(Replication& replication, const OperatorOrders& orders)
      : replication_(replication), orders_(orders) {}

  const std::optional<Eigen::Isometry3d>& of(const LayerId& layer) {
    const auto [place, is_new] = known_.try_emplace(layer);
    if (is_new) place->second = find(layer);
    return place->second;
  }

 private:
  std::optional<Eigen::Isometry3d> find(const LayerId& layer) {
    const replication::HeldLayer* const held = replication_.book().find(layer);
    if (held != nullptr && held->replica().pose().origin().revision > 0) {
      return held->replica().pose().T_fleet_layer();
    }
    LayerPose said;
    for (const auto& log : replication_.log_book().logs()) {
      if (log->log.id().origin != layer.origin) continue;
      for (const auto& [number, item] : log->log.items()) {
        const auto pose = replication::read_layer_pose(item);
        if (pose && pose->layer == layer && !pose->correction) (void)said.update_origin(pose->pose);
      }
    }
    if (said.origin().revision == 0) return std::nullopt;
    if (const auto correction = orders_.correction_of(layer)) {
      (void)said.update_correction(*correction);
    }
    return said.T_fleet_layer();
  }

  Replication& replication_;
  const OperatorOrders& orders_;
  std::map<LayerId, std::optional<Eigen::Isometry3d>> known_;
};

}  // namespace

FleetPath path_of(Replication& replication, const OperatorOrders& orders, MemberId node,
                  std::int64_t after_us) {
  FleetPath path;
  Places places(replication, orders);
  for (const auto& log : replication.log_book().logs()) {
    if (log->log.id().origin != node.number) continue;
    for (const auto& [number, item] : log->log.items()) {
      const auto chunk = read_path_chunk(item);
      if (!chunk || chunk->layer.origin != node.number) continue;
      const auto& T_fleet_layer = places.of(chunk->layer);
      for (const PathPoint& point : chunk->points) {
        if (point.time_us <= after_us) continue;
        if (!T_fleet_layer) {
          ++path.unplaced;
          continue;
        }
        path.points.push_back({point.time_us, chunk->layer, *T_fleet_layer * point.position_layer});
      }
    }
  }
  std::stable_sort(path.points.begin(), path.points.end(),
                   [](const auto& a, const auto& b) { return a.time_us < b.time_us; });
  path.more = path.points.size() > FleetPath::kPointsMax;
  if (path.more) path.points.resize(FleetPath::kPointsMax);
  return path;
}

std::uint32_t next_path_number(replication::LogBook& book, const LayerId& layer) {
  std::uint32_t next = 0;
  if (book.own() == nullptr) return next;
  for (const auto& [number, item] : book.own()->log.items()) {
    const auto chunk = read_path_chunk(item);
    if (chunk && chunk->layer == layer) next = std::max(next, chunk->number + 1);
  }
  return next;
}

}  // namespace warren
