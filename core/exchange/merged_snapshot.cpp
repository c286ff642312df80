// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/merged_snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace warren {

// Takes the voxels in the order in which the merge-map tells them: block by block.
class MergedSnapshotMaker {
 public:
  MergedSnapshotMaker(double resolution_m, const Eigen::Vector3d& origin_map) {
    made_.resolution_m_ = resolution_m;
    const auto voxels = [&](double metres) {
      return static_cast<std::int64_t>(std::llround(metres / resolution_m));
    };
    made_.origin_ = {voxels(origin_map.x()), voxels(origin_map.y()), voxels(origin_map.z())};
  }

  void add(const VoxelKey& key, const MergedVoxel& voxel) {
    const BlockOrdinal block = ordinal_of(block_of(key));
    if (made_.blocks_.empty() || made_.blocks_.back().block != block) begin(block);
    made_.mixed_.back()[morton9(key.x, key.y, key.z)] = voxel;
    ++(voxel.code.state() == VoxelState::kOccupied ? made_.counts_.occupied : made_.counts_.free);
    if (voxel.source >= is_used_.size()) is_used_.resize(std::size_t{voxel.source} + 1);
    is_used_[voxel.source] = true;
  }

  MergedSnapshot finish(const MergeMap& map) {
    close();
    number_sources(map);
    return std::move(made_);
  }

 private:
  void begin(BlockOrdinal block) {
    close();
    made_.blocks_.push_back({block, static_cast<std::uint32_t>(made_.mixed_.size()), {}});
    made_.mixed_.emplace_back();
    ++made_.counts_.blocks;
    widen_bounds(first_voxel_of(block_key_of(block)));
  }

  void close() {
    if (made_.blocks_.empty()) return;
    const MergedBlock& last = made_.mixed_.back();
    const MergedVoxel first = last.front();
    const auto is_first = [&](const MergedVoxel& voxel) { return voxel == first; };
    if (!std::all_of(last.begin(), last.end(), is_first)) return;
    made_.blocks_.back() = {made_.blocks_.back().block, std::nullopt, first};
    made_.mixed_.pop_back();
  }

  void widen_bounds(const VoxelKey& low) {
    const VoxelKey high{low.x + kBlockEdge - 1, low.y + kBlockEdge - 1, low.z + kBlockEdge - 1};
    if (!made_.bounds_) made_.bounds_ = KeyBox{low, high};
    KeyBox& box = *made_.bounds_;
    box.low = {std::min(box.low.x, low.x), std::min(box.low.y, low.y), std::min(box.low.z, low.z)};
    box.high = {std::max(box.high.x, high.x), std::max(box.high.y, high.y),
                std::max(box.high.z, high.z)};
  }

  void number_sources(const MergeMap& map) {
    std::map<LayerId, std::size_t> others;
    for (std::size_t index = 1; index < is_used_.size(); ++index) {
      if (!is_used_[index]) continue;
      const MergeSourceId& id = map.source(static_cast<SourceIndex>(index));
      if (!id.self) others.emplace(id.layer, index);
    }
    made_.numbers_.assign(is_used_.size(), 0);
    for (const auto& [layer, index] : others) {
      made_.others_.push_back(layer);
      made_.other_names_.emplace_back();
      made_.numbers_[index] = static_cast<SourceNumber>(made_.others_.size());
    }
  }

  MergedSnapshot made_;
  std::vector<bool> is_used_;  // by SourceIndex
};

void MergedSnapshot::name_others(const std::function<std::string(const LayerId&)>& name_of) {
  other_names_.clear();
  for (const LayerId& layer : others_) other_names_.push_back(name_of(layer));
}

VoxelState MergedSnapshot::state(const VoxelKey& key) const {
  if (!KeyBox{}.contains(key)) return VoxelState::kUnknown;
  const BlockOrdinal block = ordinal_of(block_of(key));
  const auto found = std::lower_bound(
      blocks_.begin(), blocks_.end(), block,
      [](const HeldBlock& held, BlockOrdinal wanted) { return held.block < wanted; });
  if (found == blocks_.end() || found->block != block) return VoxelState::kUnknown;
  return voxel(*found, morton9(key.x, key.y, key.z)).code.state();
}

void MergedSnapshot::for_each_known(const Visit& visit) const {
  for (const HeldBlock& held : blocks_) {
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      const MergedVoxel& told = voxel(held, place);
      if (told.code.state() == VoxelState::kUnknown) continue;
      visit(key_of_morton(held.block << 9 | place), told.code, numbers_[told.source]);
    }
  }
}

MergedSnapshot snapshot_of(MergeMap& map, const Eigen::Vector3d& origin_map) {
  MergedSnapshotMaker maker(map.config().resolution_m, origin_map);
  map.for_each_known_voxel(
      KeyBox{}, [&](const VoxelKey& key, const MergedVoxel& voxel) { maker.add(key, voxel); });
  return maker.finish(map);
}

}  // namespace warren
