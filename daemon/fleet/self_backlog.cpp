// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/self_backlog.hpp"

#include <utility>

namespace warren {

void SelfBacklog::add(SelfLayerWrite write) {
  const auto before = taken_.find(write.head.number);
  if (before != taken_.end() && before->second == write.head && write.blocks.empty()) return;
  taken_[write.head.number] = write.head;
  Layer& layer = waiting_[write.head.number];
  layer.head = write.head;
  for (BlockState& block : write.blocks) {
    layer.blocks.insert_or_assign(ordinal_of(block.key), std::move(block));
  }
}

std::vector<SelfLayerWrite> SelfBacklog::take() {
  std::vector<SelfLayerWrite> writes;
  under_way_ = std::exchange(waiting_, {});
  for (const auto& [number, layer] : under_way_) {
    SelfLayerWrite& write = writes.emplace_back();
    write.head = layer.head;
    write.blocks.reserve(layer.blocks.size());
    for (const auto& [ordinal, block] : layer.blocks) write.blocks.push_back(block);
  }
  return writes;
}

// What has been added since is later, and stays.
void SelfBacklog::on_refused() {
  for (auto& [number, before] : std::exchange(under_way_, {})) {
    const auto [layer, alone] = waiting_.try_emplace(number, before);
    if (!alone) layer->second.blocks.merge(before.blocks);
  }
}

}  // namespace warren
