// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/layer/merge_map.hpp"
#include "core/voxel/scan.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

// Whose word a voxel is: 0 this robot's own, n that of others()[n - 1].
using SourceNumber = std::uint16_t;

// All that the merge-map holds, for writing it to a file while the map itself goes on. Needs
// neither the merge-map nor its replicas; const access from any thread.
class MergedSnapshot {
 public:
  using Visit = std::function<void(const VoxelKey&, VoxelCode, SourceNumber)>;

  double resolution_m() const { return resolution_m_; }
  // Of the merge-map's lattice in the map frame.
  const LayerOrigin& origin() const { return origin_; }
  // The layers of others that have a voxel here, by rising id.
  const std::vector<LayerId>& others() const { return others_; }
  // The names of the nodes that made them, in the same order; empty where one has none.
  const std::vector<std::string>& other_names() const { return other_names_; }
  // `name_of` is called once for each of them.
  void name_others(const std::function<std::string(const LayerId&)>& name_of);
  const MapCounts& counts() const { return counts_; }
  // Smallest box of blocks that holds all known voxels; nothing when there are none.
  const std::optional<KeyBox>& bounds() const { return bounds_; }

  VoxelState state(const VoxelKey& key) const;
  // In Morton order.
  void for_each_known(const Visit& visit) const;

 private:
  // Most blocks are air that one layer told of; they need no voxels of their own.
  struct HeldBlock {
    BlockOrdinal block = 0;
    std::optional<std::uint32_t> mixed;  // its place among the mixed ones; none: all are `uniform`
    MergedVoxel uniform;
  };
  friend class MergedSnapshotMaker;

  const MergedVoxel& voxel(const HeldBlock& held, std::uint32_t place) const {
    return held.mixed ? mixed_[*held.mixed][place] : held.uniform;
  }

  double resolution_m_ = 0.1;
  LayerOrigin origin_;
  std::vector<LayerId> others_;
  std::vector<std::string> other_names_;
  std::vector<SourceNumber> numbers_;  // by the merge-map's SourceIndex
  MapCounts counts_;
  std::optional<KeyBox> bounds_;
  std::vector<HeldBlock> blocks_;  // by rising ordinal
  std::deque<MergedBlock> mixed_;
};

// `origin_map`: of the merge-map's key (0, 0, 0), metres, whole voxels. Derives all of the
// merge-map, so that its cache is filled with other blocks afterwards.
MergedSnapshot snapshot_of(MergeMap& map, const Eigen::Vector3d& origin_map);

}  // namespace warren
