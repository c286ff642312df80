// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>

#include "core/layer/coded_block.hpp"
#include "core/layer/merge_placement.hpp"
#include "core/layer/merge_times.hpp"
#include "core/layer/replica.hpp"

namespace warren {

// Whose voxels: a layer of this node itself, of which only the number counts, or one of others.
struct MergeSourceId {
  bool self = false;
  LayerId layer;
  friend auto operator<=>(const MergeSourceId&, const MergeSourceId&) = default;
};

// What one layer says of a block of the merge-map, and when its origin changed that last.
struct SampledBlock {
  std::array<VoxelCode, kVoxelsPerBlock> codes{};
  std::array<std::int64_t, kVoxelsPerBlock> changed_ns{};
};

// A layer as the merge-map sees it: its blocks, wherever they are kept, and its place.
class MergeSource {
 public:
  // A layer of this node; the source keeps its codes.
  MergeSource(std::uint32_t number, double resolution_m, const MergePlacement& placement);
  // A layer of others, in a replica that must stay where it is.
  MergeSource(const LayerId& id, const Replica& replica, double resolution_m,
              const MergePlacement& placement);

  const MergeSourceId& id() const { return id_; }
  double resolution_m() const { return resolution_m_; }
  const MergePlacement& placement() const { return placement_; }
  void move(const MergePlacement& placement) { placement_ = placement; }

  // A layer that does not count keeps its place.
  bool counts() const { return counts_; }
  void set_counts(bool counts) { counts_ = counts; }

  // Only for a layer of this node. Whether it had other codes before: most blocks that a scan
  // touches keep theirs.
  bool keep(const CodedBlock& block);

  bool has_codes(BlockOrdinal block) const;
  // Blocks with codes, as the merge-map was last told.
  std::unordered_set<BlockOrdinal>& known_blocks() { return known_blocks_; }
  const std::unordered_set<BlockOrdinal>& known_blocks() const { return known_blocks_; }
  // Calls visit(BlockOrdinal) for every block that has codes now.
  template <typename Visit>
  void for_each_block(Visit&& visit) const;
  // The same for those that changed after `from`. Only for a layer of others.
  template <typename Visit>
  void for_each_changed(Revision from, Visit&& visit) const;

  MergeTimes& times() { return times_; }

  std::size_t memory_bytes() const;

  // Overwrites `sampled`; false if the layer knows nothing of the block.
  bool sample(const BlockKey& merge_block, SampledBlock& sampled) const;

 private:
  struct Found {
    const CodeBlock* codes = nullptr;
    std::int64_t changed_ns = 0;
  };

  Found find(const BlockKey& block) const;
  bool sample_shifted(const BlockKey& merge_block, const BlockBox& box,
                      SampledBlock& sampled) const;
  bool resample(const BlockKey& merge_block, const BlockBox& box, SampledBlock& sampled) const;

  MergeSourceId id_;
  double resolution_m_ = 0.0;
  MergePlacement placement_;
  bool counts_ = true;
  const Replica* replica_ = nullptr;
  std::unordered_map<BlockOrdinal, CodeBlock> own_blocks_;
  std::unordered_set<BlockOrdinal> known_blocks_;
  MergeTimes times_;
};

template <typename Visit>
void MergeSource::for_each_block(Visit&& visit) const {
  if (replica_ == nullptr) {
    for (const auto& [block, codes] : own_blocks_) visit(block);
    return;
  }
  for_each_changed({}, visit);
}

template <typename Visit>
void MergeSource::for_each_changed(Revision from, Visit&& visit) const {
  replica_->for_each_changed({}, from, [&](BlockOrdinal block, const LayerBlock& found) {
    if (!found.codes.empty()) visit(block);
    return true;
  });
}

}  // namespace warren
