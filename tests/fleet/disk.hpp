// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "daemon/replication/replication.hpp"

namespace warren::fleet_sim {

// What a node's store has. A batch is written whole or not at all.
class Disk {
 public:
  struct Layer {
    Resolution resolution;
    bool own = false;
    Holdings holdings;
    std::map<BlockOrdinal, StoredBlock> blocks;
  };

  void write(const replication::StoreBatch& batch) {
    for (const replication::StoredLayer& stored : batch.layers) {
      Layer& layer = layers_[stored.id];
      layer.resolution = stored.resolution;
      layer.own = stored.own;
      layer.holdings = stored.holdings;
      for (const KeyInterval& keys : stored.forgotten) {
        layer.blocks.erase(layer.blocks.lower_bound(keys.first),
                           layer.blocks.lower_bound(keys.end));
      }
      for (const StoredBlock& block : stored.blocks) {
        layer.blocks.insert_or_assign(block.block, block);
      }
    }
    for (const replication::StoredLog& stored : batch.logs) write(stored);
  }
  std::vector<replication::StoredLog> logs() const {
    std::vector<replication::StoredLog> logs;
    for (const auto& [id, log] : logs_) logs.push_back(log);
    return logs;
  }
  std::unique_ptr<Replica> read(const LayerId& id) const {
    const Layer& layer = layers_.at(id);
    std::vector<StoredBlock> blocks;
    for (const auto& [block, stored] : layer.blocks) blocks.push_back(stored);
    return std::make_unique<Replica>(id, layer.resolution, layer.holdings, blocks);
  }
  void lose() {
    layers_.clear();
    logs_.clear();
  }
  const std::map<LayerId, Layer>& layers() const { return layers_; }

 private:
  void write(const replication::StoredLog& stored) {
    replication::StoredLog& log = logs_[stored.id];
    log.id = stored.id;
    log.own = stored.own;
    log.voided = stored.voided;
    log.seen = stored.seen;
    for (const auto& [number, item] : stored.items) {
      log.items.erase(number);
      if (item) log.items.emplace(number, item);
    }
  }

  std::map<LayerId, Layer> layers_;
  std::map<replication::LogId, replication::StoredLog> logs_;
};

}  // namespace warren::fleet_sim
