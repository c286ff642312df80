// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/layer/merge_cache.hpp"
#include "core/layer/merge_index.hpp"
#include "core/layer/merge_rule.hpp"
#include "core/layer/merge_source.hpp"
#include "core/voxel/ray_cast.hpp"

namespace warren {

struct MergeConfig {
  double resolution_m = 0.1;
  MergeRule rule = MergeRule::kSafest;
  std::size_t cached_blocks = 32768;  // 0.5 kB each, 1.5 where more than two layers meet
};

enum class MergeResult : std::uint8_t {
  kDone,
  kUnknownLayer,
  kKnownLayer,     // it is there already
  kBadPose,        // not finite, not rigid, or absurdly far
  kBadResolution,  // too many times finer or coarser than the merge-map
  kTooManyLayers,
};

// What this node knows by itself and from others (paper Eq. 10c): a voxel that any layer of its own
// knows is never replaced; elsewhere the layers of others count, by the config's rule. Layers never
// mix: the content is a function of the layers that count, their blocks and poses, whatever the
// order in which they came, so each can be moved, retracted and restored exactly.
//
// A layer that lies askew, or is of another resolution, is resampled on the safe side: a voxel is
// occupied if the centre of an occupied voxel falls in it or its own centre lies in one, with the
// highest cost of these, and a stair if any is; else it is what its centre lies in. What falls
// outside the key space is left out and counted.
//
// Blocks are derived when they are asked for. One thread at a time.
class MergeMap {
 public:
  static constexpr std::size_t kLayersMax = 4096;
  // Regions that no layer reaches any more, kept for the sake of blocks_changed_since().
  static constexpr std::size_t kUntouchedRegionsMax = 1024;

  explicit MergeMap(const MergeConfig& config);

  const MergeConfig& config() const { return config_; }
  const Lattice& lattice() const { return lattice_; }

  // Layers of this node, of the merge-map's resolution. Where two of them know a voxel, the higher
  // number wins.
  MergeResult open_self_layer(std::uint32_t number, const Eigen::Isometry3d& T_merge_layer);
  // These blocks have these codes now.
  MergeResult update_self(std::uint32_t number, std::span<const CodedBlock> blocks);
  MergeResult move_self_layer(std::uint32_t number, const Eigen::Isometry3d& T_merge_layer);
  // As if it had never been opened, until it is restored.
  MergeResult retract_self_layer(std::uint32_t number);
  MergeResult restore_self_layer(std::uint32_t number);

  // A layer of others, with all blocks it has now. The replica must stay where it is until the
  // layer is removed, and the merge-map be told of every block whose codes change.
  MergeResult add_layer(const LayerId& id, const Replica& replica, double resolution_m,
                        const Eigen::Isometry3d& T_merge_layer);
  MergeResult block_changed(const LayerId& id, BlockOrdinal block);
  // When the origin made this revision; only MergeRule::kNewest asks for it.
  MergeResult note_time(const LayerId& id, Revision revision, std::int64_t fleet_time_ns);
  MergeResult move_layer(const LayerId& id, const Eigen::Isometry3d& T_merge_layer);
  // As if it had never been merged, until it is restored.
  MergeResult retract_layer(const LayerId& id);
  MergeResult restore_layer(const LayerId& id);
  MergeResult remove_layer(const LayerId& id);

  // Where several layers of others agree, the one with the lowest id is told, of those whose state
  // and cost won.
  MergedVoxel voxel(const VoxelKey& key) {
    return KeyBox{}.contains(key) ? voxel_within(key) : MergedVoxel{};
  }
  MergedVoxel voxel(const Point3f& point_merge) {
    const auto key = lattice_.key_of(point_merge);
    return key ? voxel_within(*key) : MergedVoxel{};
  }
  // Precondition: the index came with a voxel, and its layer was not removed since.
  const MergeSourceId& source(SourceIndex index) const { return sources_[index]->id(); }

  // The same as SelfMap::cast_ray; origin and direction are in the merge-map's frame.
  std::optional<RayHit> cast_ray(const RayQuery& query);

  // Calls visit(key, voxel) for every known voxel in the box, blocks in Morton order.
  using VoxelVisitor = std::function<void(const VoxelKey&, const MergedVoxel&)>;
  void for_each_known_voxel(const KeyBox& box, const VoxelVisitor& visit);

  // At least all blocks that changed after `cursor`, in Morton order; 0 gives all. Nothing if that
  // is too long ago: begin anew with all blocks. cursor() is the number of the last change.
  std::optional<std::vector<BlockKey>> blocks_changed_since(std::uint64_t cursor) const;
  std::uint64_t cursor() const { return changes_; }
  bool remembers(std::uint64_t cursor) const { return cursor == 0 || cursor >= forgotten_until_; }
  // The same for those in the box, from `first` on: calls visit(key) as long as it returns true.
  // Precondition: remembers(cursor).
  using BlockVisitor = std::function<bool(const BlockKey&)>;
  void for_each_changed_block(std::uint64_t cursor, const BlockBox& box, BlockOrdinal first,
                              const BlockVisitor& visit) const;
  // All codes of a block, in Morton order.
  std::array<VoxelCode, kVoxelsPerBlock> codes(const BlockKey& block);

  // Blocks of layers that lie outside the key space, wholly or in part.
  std::uint64_t blocks_outside_key_space() const { return blocks_outside_; }
  std::size_t cached_blocks() const { return cache_.size(); }
  // Without the replicas.
  std::size_t memory_bytes() const;

 private:
  using Order = std::map<MergeSourceId, SourceIndex>;  // others by id, then self by number

  MergeResult add(std::unique_ptr<MergeSource> source);
  MergeSource* find(const MergeSourceId& id) const;
  std::optional<MergePlacement> place(const Eigen::Isometry3d& T_merge_layer,
                                      double resolution_m) const;
  MergeResult move(const MergeSourceId& id, const Eigen::Isometry3d& T_merge_layer);
  MergeResult retract(const MergeSourceId& id);
  MergeResult restore(const MergeSourceId& id);
  void update_block(MergeSource& source, BlockOrdinal block);
  void touch_all(MergeSource& source);
  void untouch_all(MergeSource& source);
  void touch(const MergeSource& source, BlockOrdinal block);
  void untouch(const MergeSource& source, BlockOrdinal block);
  void mark_changed(const MergeSource& source, BlockOrdinal block);
  void begin_change() { ++changes_; }
  void forget_untouched_regions();

  // Precondition: the voxel lies in the key space.
  MergedVoxel voxel_within(const VoxelKey& key) {
    MergeEntry* const entry = index_.find(key);
    if (entry == nullptr) return {};
    if (!entry->is_derived()) derive(*entry, block_of(key));
    return voxel_of(*entry, morton9(key.x, key.y, key.z));
  }
  // Precondition: the entry is derived.
  MergedVoxel voxel_of(const MergeEntry& entry, std::uint32_t place) {
    return entry.is_uniform() ? entry.uniform() : cache_.voxel(entry, place);
  }
  void derive(MergeEntry& entry, const BlockKey& block);
  MergedBlock merge(const BlockKey& block) const;

  MergeConfig config_;
  Lattice lattice_;
  std::vector<std::unique_ptr<MergeSource>> sources_;  // by SourceIndex; null where removed
  Order order_;
  MergeIndex index_;
  MergeCache cache_;
  std::uint64_t changes_ = 0;
  std::uint64_t forgotten_until_ = 0;
  std::uint64_t blocks_outside_ = 0;
};

}  // namespace warren
