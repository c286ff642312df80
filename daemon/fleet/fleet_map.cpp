// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet_map.hpp"

#include <algorithm>

namespace warren {

void FleetMap::tick(std::span<const LayerChanges> changes) {
  ++ticks_;
  for (const LayerChanges& layer : changes) own_layer(layer.number).tick(layer.blocks);
}

void FleetMap::flush() {
  for (auto& [number, layer] : own_) layer.flush();
}

OwnLayer& FleetMap::own_layer(std::uint32_t number) {
  const auto found = own_.find(number);
  if (found != own_.end()) return found->second;
  const LayerId id{config_.origin, number, draw_incarnation_()};
  return own_.try_emplace(number, id, config_.publishing).first->second;
}

const Replica* FleetMap::current() const {
  return own_.empty() ? nullptr : &own_.rbegin()->second.layer();
}

PublishingReport FleetMap::report() const {
  PublishingReport report;
  report.layers = static_cast<std::uint32_t>(own_.size());
  report.ticks = ticks_;
  for (const auto& [number, layer] : own_) {
    report.traffic += layer.traffic();
    report.blocks_held_back += layer.blocks_held_back();
    report.memory_bytes += layer.layer().memory_bytes();
  }
  if (const Replica* const layer = current()) {
    report.current = {layer->id(), layer->holdings().at(0), layer->digest().root()};
  }
  return report;
}

std::optional<LayerDiff> FleetMap::diff(const KeyInterval& keys, Revision from) const {
  const Replica* const layer = current();
  if (layer == nullptr) return std::nullopt;
  LayerDiff diff{layer->id(), config_.resolution_m, layer->holdings().at(0), {}, kOrdinalEnd};
  EncodeRequest request{keys, from, config_.publishing.packet_bytes};
  std::size_t bytes = 0;
  while (auto packet = layer->encode(request)) {
    if (bytes + packet->bytes.size() > kDiffBytesMax) {
      diff.next_key = request.keys.first;
      break;
    }
    bytes += packet->bytes.size();
    request.keys.first = packet->claim.keys.end;
    diff.packets.push_back(std::move(packet->bytes));
  }
  return diff;
}

}  // namespace warren
