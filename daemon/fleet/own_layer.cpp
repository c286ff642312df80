// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/own_layer.hpp"

namespace warren {

void OwnLayer::tick(std::span<const CodedBlock> changed) {
  traffic_.bytes_of_last_tick = 0;
  ticks_at_rest_ = changed.empty() ? ticks_at_rest_ + 1 : 0;
  publish(publisher_.tick(changed, layer_));
  if (ticks_at_rest_ == config_.flush_after_ticks) flush();
}

void OwnLayer::move(const Eigen::Isometry3d& T_fleet_map) {
  const std::uint32_t revision = layer_.pose().origin().revision;
  if (revision > 0 && T_fleet_map.matrix() == T_fleet_map_.matrix()) return;
  T_fleet_map_ = T_fleet_map;
  const Eigen::Isometry3d T_fleet_layer = this->T_fleet_layer();
  layer_.pose().update_origin(
      {revision + 1,
       layer_.id().origin,
       {T_fleet_layer.translation(), Eigen::Quaterniond(T_fleet_layer.linear())}});
}

void OwnLayer::flush() { publish(publisher_.flush(layer_)); }

void OwnLayer::publish(std::span<const CodedBlock> blocks) {
  EncodeRequest request{{}, layer_.holdings().at(0), config_.packet_bytes};
  layer_.publish(blocks);
  while (const auto packet = layer_.encode(request)) {
    request.keys.first = packet->claim.keys.end;
    ++traffic_.packets;
    traffic_.bytes += packet->bytes.size();
    traffic_.bytes_of_last_tick += packet->bytes.size();
  }
}

}  // namespace warren
