// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/store_batch.hpp"

#include <utility>

namespace warren {
namespace {

std::size_t heap_bytes(const BlockState& state) {
  return state.values.size() * sizeof(state.values[0]) + state.costs.size() * sizeof(FusedCost);
}

bool equal(const SelfMapConfig& a, const SelfMapConfig& b) {
  return a.resolution_m == b.resolution_m && a.sensor_model == b.sensor_model &&
         a.one_ray_per_end_voxel == b.one_ray_per_end_voxel &&
         a.cost_fusion.rule == b.cost_fusion.rule &&
         a.cost_fusion.information_limit == b.cost_fusion.information_limit;
}

}  // namespace

bool operator==(const SelfLayerHead& a, const SelfLayerHead& b) {
  return a.number == b.number && a.frame_epoch == b.frame_epoch && a.origin == b.origin &&
         equal(a.config, b.config) && a.scans == b.scans && a.cursor == b.cursor &&
         a.T_fleet_map.translation == b.T_fleet_map.translation &&
         a.T_fleet_map.rotation.coeffs() == b.T_fleet_map.rotation.coeffs() &&
         a.gravity_map == b.gravity_map;
}

std::size_t StoreBatch::memory_bytes() const {
  std::size_t bytes = sizeof(StoreBatch);
  for (const LayerWrite& layer : layers) {
    bytes += sizeof layer + layer.blocks.size() * sizeof(StoredBlock);
    for (const StoredBlock& block : layer.blocks) bytes += block.codes.heap_bytes();
  }
  for (const SelfLayerWrite& layer : self_layers) {
    bytes += sizeof layer + layer.blocks.size() * sizeof(BlockState);
    for (const BlockState& block : layer.blocks) bytes += heap_bytes(block);
  }
  for (const LogItem& item : items) bytes += sizeof item + item.bytes.size();
  for (const auto& [name, state] : states) bytes += name.size() + state.size();
  return bytes + receipts.size() * sizeof(LogReceipt) + erased_items.size() * sizeof(LogItemId) +
         counters.size() * 64;
}

std::vector<StoredBlock> blocks_told(const Replica& replica, std::span<const Claim> applied) {
  std::map<BlockOrdinal, StoredBlock> told;
  for (const Claim& claim : applied) {
    replica.for_each_changed(claim.keys, claim.from,
                             [&](BlockOrdinal ordinal, const LayerBlock& block) {
                               told[ordinal] = {ordinal, block.history.latest(), block.codes};
                               return true;
                             });
  }
  std::vector<StoredBlock> blocks;
  blocks.reserve(told.size());
  for (auto& [ordinal, block] : told) blocks.push_back(std::move(block));
  return blocks;
}

LayerWrite write_of(const Replica& replica, bool own, std::span<const Claim> applied) {
  return {{replica.id(), replica.resolution(), own, replica.pose(), replica.holdings()},
          {},
          blocks_told(replica, applied)};
}

}  // namespace warren
