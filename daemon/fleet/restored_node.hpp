// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/layer/replica.hpp"
#include "core/voxel/self_map.hpp"
#include "daemon/mapper/layered_map.hpp"
#include "daemon/replication/replication.hpp"
#include "daemon/store/store.hpp"

namespace warren {

// An own layer that goes on where it was.
struct StoredOwnLayer {
  Replica layer;
  LayerOrigin origin;
  Pose T_fleet_map;
};

// Layers that this node holds and does not write, logs, and counts over all lives on this store.
struct StoredFleet {
  std::vector<std::unique_ptr<Replica>> copies;
  std::vector<replication::StoredLog> logs;
  std::map<std::string, std::uint64_t> counters;
};

// What a node was when it ended, for its parts to go on with.
struct StoredNode {
  StoredMap map;
  std::vector<StoredOwnLayer> own;  // by their numbers
  StoredFleet fleet;
  std::uint64_t layers_ended = 0;  // own ones that are kept and shared, but not continued
  std::uint64_t items_refused = 0;
};

// Takes all out of a store that has just been opened. Own layers, and the self-map behind them, go
// on if the store never lost one of their revisions and they were mapped with this config; else
// they are held like those of others. After such a loss the self-map goes on under new layers, and
// the own log is not continued. The error is the disk's, in words for the operator.
tl::expected<StoredNode, std::string> restore_node(Store& store, const StartReport& start,
                                                   const SelfMapConfig& config);

}  // namespace warren
