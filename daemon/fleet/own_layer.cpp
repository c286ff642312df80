// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/own_layer.hpp"

#include <utility>
#include <vector>

namespace warren {

OwnLayer::OwnLayer(StoredOwnLayer stored, const PublishingConfig& config,
                   std::uint32_t rest_after_ticks)
    : OwnLayer(stored.layer.id(), stored.layer.resolution(),
               stored.origin.position_map(stored.layer.resolution().metres()), config,
               rest_after_ticks) {
  layer_ = std::move(stored.layer);
  const auto T_fleet_map = stored.T_fleet_map.checked();
  is_placed_ = T_fleet_map && layer_.pose().origin().revision > 0;
  if (is_placed_) T_fleet_map_ = *T_fleet_map;
  apply_correction();
}

void OwnLayer::tick(std::span<const CodedBlock> changed) {
  traffic_.bytes_of_last_tick = 0;
  ticks_at_rest_ = changed.empty() ? ticks_at_rest_ + 1 : 0;
  publish(publisher_.tick(changed, layer_));
  if (ticks_at_rest_ == config_.flush_after_ticks) flush();
}

void OwnLayer::move(const Eigen::Isometry3d& T_fleet_map) {
  if (is_placed_ && T_fleet_map.matrix() == T_fleet_map_.matrix()) return;
  is_placed_ = true;
  T_fleet_map_ = T_fleet_map;
  // Beyond a pose's reach the layer keeps the one before, which counts as refused.
  const std::uint32_t revision = layer_.pose().origin().revision;
  const Eigen::Isometry3d T_fleet_layer = T_fleet_map_ * T_map_layer_;
  layer_.pose().update_origin({revision + 1, layer_.id().origin, Pose::of(T_fleet_layer)});
  apply_correction();
}

bool OwnLayer::correct(const WrittenPose& correction) {
  const bool taken = layer_.pose().update_correction(correction) == PoseResult::kTaken;
  if (taken) apply_correction();
  return taken;
}

// Exactly as it was where there is none, so that nothing moves by a rounding.
void OwnLayer::apply_correction() {
  const WrittenPose& correction = layer_.pose().correction();
  corrected_T_fleet_map_ =
      correction.revision == 0 ? T_fleet_map_ : *correction.pose.checked() * T_fleet_map_;
}

std::size_t OwnLayer::flush() {
  const std::vector<CodedBlock> held_back = publisher_.flush(layer_);
  publish(held_back);
  return held_back.size();
}

void OwnLayer::publish(std::span<const CodedBlock> blocks) {
  const Revision before = layer_.holdings().at(0);
  layer_.publish(blocks);
  for_each_packet(layer_, {{}, before, config_.packet_bytes}, [&](const DiffPacket& packet) {
    ++traffic_.packets;
    traffic_.bytes += packet.bytes.size();
    traffic_.bytes_of_last_tick += packet.bytes.size();
    return true;
  });
}

}  // namespace warren
