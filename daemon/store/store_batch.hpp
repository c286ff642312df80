// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/layer/holdings.hpp"
#include "core/layer/layer_pose.hpp"
#include "core/layer/replica.hpp"
#include "core/voxel/block_state.hpp"
#include "core/voxel/self_map.hpp"
#include "transport/mesh_id.hpp"

namespace warren {

// A layer without its blocks.
struct LayerHead {
  LayerId id;
  Resolution resolution;
  bool own = false;  // this node writes it
  LayerPose pose;
  Holdings holdings{Revision{}};
  friend bool operator==(const LayerHead&, const LayerHead&) = default;
};

// What became of a layer since it was written last; at first, all of it.
struct LayerWrite {
  LayerHead head;
  std::vector<KeyInterval> forgotten;  // by Replica::forget(); emptied before `blocks` are put
  std::vector<StoredBlock> blocks;     // see blocks_told(): not only those whose codes changed
};

// A layer of the self-map without its blocks: what a LayeredMap needs to go on with it.
struct SelfLayerHead {
  std::uint32_t number = 0;  // of the layer among those of this node, as in its LayerId
  std::uint64_t frame_epoch = 0;
  LayerOrigin origin;
  SelfMapConfig config;  // what its log-odds are steps of
  std::uint64_t scans = 0;
  std::uint32_t cursor = 0;
  Pose T_fleet_map;
  Eigen::Vector3d gravity_map{0.0, 0.0, -1.0};
};
bool operator==(const SelfLayerHead& a, const SelfLayerHead& b);

struct SelfLayerWrite {
  SelfLayerHead head;
  std::vector<BlockState> blocks;  // those that changed since the last write
};

// An item of an origin's log. The incarnation is that of the log: 64 random bits drawn when its
// numbering begins, so that a node that lost its store never uses a number twice.
struct LogItemId {
  MemberId origin;
  std::uint64_t incarnation = 0;
  std::uint64_t sequence = 0;
  friend auto operator<=>(const LogItemId&, const LogItemId&) = default;
};

struct LogItem {
  LogItemId id;
  bool own = false;  // of this node's log: never evicted
  std::uint16_t kind = 0;
  std::optional<MemberId> destination;  // none: to all
  std::vector<MemberId> receipts;       // ascending
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const LogItem&, const LogItem&) = default;
};

struct LogReceipt {
  LogItemId item;
  MemberId from;
};

// All that is written in one transaction: all of it, or nothing.
struct StoreBatch {
  std::vector<LayerWrite> layers;  // none twice
  std::vector<SelfLayerWrite> self_layers;
  std::vector<LogItem> items;
  std::vector<LogReceipt> receipts;  // of unknown items: ignored
  std::vector<LogItemId> erased_items;
  std::vector<LayerId> erased_layers;
  std::map<std::string, std::uint64_t> counters;            // in place of what they were
  std::map<std::string, std::vector<std::uint8_t>> states;  // likewise; empty: erased
  // Others have heard of commits that this store does not know: it was put back from a copy. The
  // next start treats it as one that lost them.
  bool is_behind = false;

  // Roughly, on the heap.
  std::size_t memory_bytes() const;
};

// The blocks that packets with these claims may have told of, as they are now. Besides those whose
// codes changed there are those that only became known as changed and back: a copy that forgot this
// would not tell others.
std::vector<StoredBlock> blocks_told(const Replica& replica, std::span<const Claim> applied);
// The layer as it is, with those blocks.
LayerWrite write_of(const Replica& replica, bool own, std::span<const Claim> applied);

}  // namespace warren
