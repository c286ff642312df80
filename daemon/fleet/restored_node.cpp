// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/restored_node.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "daemon/fleet/store_rows.hpp"

namespace warren {
namespace {

bool is_of(const SelfMapConfig& config, const SelfLayerHead& head) {
  SelfLayerHead same = head;
  same.config = config;
  return same == head;
}

// The self-map behind an own layer, if that may go on.
const SelfLayerHead* continued(const StoredLayer& layer, const SelfMapConfig& config,
                               const std::vector<SelfLayerHead>& heads) {
  if (!layer.head.own || layer.closed) return nullptr;
  const auto head = std::find_if(heads.begin(), heads.end(), [&](const SelfLayerHead& each) {
    return each.number == layer.head.id.number;
  });
  return head != heads.end() && is_of(config, *head) ? &*head : nullptr;
}

bool is_closed(std::uint32_t number, const std::vector<StoredLayer>& layers) {
  return std::any_of(layers.begin(), layers.end(), [&](const StoredLayer& layer) {
    return layer.head.own && layer.closed && layer.head.id.number == number;
  });
}

bool has_successor(const SelfLayerHead& head, const std::vector<SelfLayerHead>& heads) {
  return std::any_of(heads.begin(), heads.end(), [&](const SelfLayerHead& other) {
    return other.frame_epoch == head.frame_epoch && other.number > head.number;
  });
}

std::optional<StoreFailure> restore_layers(Store& store, const SelfMapConfig& config,
                                           StoredNode& node) {
  const std::vector<SelfLayerHead> heads = store.self_layers();
  std::map<std::uint32_t, StoredOwnLayer> own;
  for (const StoredLayer& layer : store.layers()) {
    auto replica = store.replica(layer.head);
    if (!replica) return replica.error();
    const LayerId& id = layer.head.id;
    if (layer.head.own) node.map.next_number = std::max(node.map.next_number, id.number + 1);
    if (const SelfLayerHead* const self = continued(layer, config, heads)) {
      own.emplace(id.number, StoredOwnLayer{std::move(*replica), self->origin, self->T_fleet_map});
      continue;
    }
    node.layers_ended += layer.head.own ? 1 : 0;
    node.fleet.copies.push_back(std::make_unique<Replica>(std::move(*replica)));
  }
  for (auto& [number, layer] : own) node.own.push_back(std::move(layer));
  return std::nullopt;
}

std::optional<StoreFailure> restore_self_maps(Store& store, const SelfMapConfig& config,
                                              StoredMap& map) {
  const std::vector<StoredLayer> layers = store.layers();
  const std::vector<SelfLayerHead> heads = store.self_layers();
  for (const SelfLayerHead& head : heads) {
    map.next_number = std::max(map.next_number, head.number + 1);
  }
  for (SelfLayerHead head : heads) {
    const bool closed = is_closed(head.number, layers);
    if (!is_of(config, head) || (closed && has_successor(head, heads))) continue;
    auto voxels = store.self_map(head);
    if (!voxels) return voxels.error();
    if (closed) {
      // What was measured stays: it is published, and stored, anew.
      head.number = map.next_number++;
      head.cursor = 0;
    }
    map.layers.emplace_back(head, std::move(*voxels));
  }
  return std::nullopt;
}

std::optional<StoreFailure> restore_logs(Store& store, bool rolled_back, StoredNode& node) {
  const auto items = store.items();
  if (!items) return items.error();
  const auto states = store.states();
  if (!states) return states.error();
  StoredLogs logs = logs_of(*items, *states);
  // Numbers of it may be known elsewhere that are not known here.
  for (replication::StoredLog& log : logs.logs) log.own = log.own && !rolled_back;
  node.fleet.logs = std::move(logs.logs);
  node.items_refused = logs.refused;
  return std::nullopt;
}

std::optional<StoreFailure> restore_counters(Store& store, StoredNode& node) {
  auto counters = store.counters();
  if (!counters) return counters.error();
  node.fleet.counters = std::move(*counters);
  return std::nullopt;
}

}  // namespace

tl::expected<StoredNode, std::string> restore_node(Store& store, const StartReport& start,
                                                   const SelfMapConfig& config) {
  StoredNode node;
  auto failure = restore_layers(store, config, node);
  if (!failure) failure = restore_self_maps(store, config, node.map);
  if (!failure) failure = restore_logs(store, start.rolled_back, node);
  if (!failure) failure = restore_counters(store, node);
  if (failure) return tl::unexpected("the store cannot be read: " + failure->text);
  return node;
}

}  // namespace warren
