// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/layer/merge_map.hpp"

namespace warren {
namespace {

bool intersect(const KeyBox& box, const VoxelKey& low, std::int32_t edge) {
  const auto overlap = [edge](std::int32_t from, std::int32_t to, std::int32_t first) {
    return first <= to && first + edge - 1 >= from;
  };
  return overlap(box.low.x, box.high.x, low.x) && overlap(box.low.y, box.high.y, low.y) &&
         overlap(box.low.z, box.high.z, low.z);
}

void merge_safest(const SampledBlock& sampled, SourceIndex source, MergedBlock& merged) {
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    MergedVoxel& voxel = merged[place];
    const VoxelCode code = sampled.codes[place];
    if (is_safer(code, voxel.code) ||
        (voxel.source == kNoSource && code.state() != VoxelState::kUnknown)) {
      voxel.source = source;
    }
    voxel.code = safest(code, voxel.code);
  }
}

using BlockTimes = std::array<std::int64_t, kVoxelsPerBlock>;

void merge_newest(const SampledBlock& sampled, SourceIndex source, MergedBlock& merged,
                  BlockTimes& times_ns) {
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelCode code = sampled.codes[place];
    if (code.state() == VoxelState::kUnknown) continue;
    const bool first = merged[place].source == kNoSource;
    if (!first && sampled.changed_ns[place] <= times_ns[place]) continue;
    merged[place] = {code, source};
    times_ns[place] = sampled.changed_ns[place];
  }
}

void overlay_self(const SampledBlock& sampled, SourceIndex source, MergedBlock& merged) {
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelCode code = sampled.codes[place];
    if (code.state() != VoxelState::kUnknown) merged[place] = {code, source};
  }
}

}  // namespace

std::optional<RayHit> MergeMap::cast_ray(const RayQuery& query) {
  return warren::cast_ray(lattice_, query,
                          [this](const VoxelKey& key) { return voxel(key).code.state(); });
}

void MergeMap::for_each_known_voxel(const KeyBox& box, const VoxelVisitor& visit) {
  const auto visit_block = [&](const BlockKey& key, const MergedBlock& block) {
    const VoxelKey first = first_voxel_of(key);
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      if (block[place].code.state() == VoxelState::kUnknown) continue;
      const VoxelKey within = place_of_morton9(place);
      const VoxelKey voxel{first.x + within.x, first.y + within.y, first.z + within.z};
      if (box.contains(voxel)) visit(voxel, block[place]);
    }
  };
  for (MergeIndex::Region* const region : index_.regions_in_order()) {
    const VoxelKey low{region->key.x * kRegionEdge, region->key.y * kRegionEdge,
                       region->key.z * kRegionEdge};
    if (region->touched == 0 || !intersect(box, low, kRegionEdge)) continue;
    for (std::uint32_t slot = 0; slot < kBlocksPerRegion; ++slot) {
      const BlockKey key = block_in_region(region->key, slot);
      if (!intersect(box, first_voxel_of(key), kBlockEdge)) continue;
      MergeEntry& entry = region->entries[slot];
      if (region->touches[slot].touches == 0) continue;
      if (!entry.is_derived()) derive(entry, key);
      // A copy: the visitor may ask for other blocks, which can push this one out.
      MergedBlock block;
      for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
        block[place] = voxel_of(entry, place);
      }
      visit_block(key, block);
    }
  }
}

void MergeMap::derive(MergeEntry& entry, const BlockKey& block) {
  if (!index_.is_touched(block)) return entry.set_uniform({});
  const MergedBlock merged = merge(block);
  const bool uniform = std::all_of(merged.begin(), merged.end(), [&](const MergedVoxel& voxel) {
    return voxel == merged.front();
  });
  if (uniform) {
    entry.set_uniform(merged.front());
  } else {
    cache_.put(entry, merged);
  }
}

MergedBlock MergeMap::merge(const BlockKey& block) const {
  MergedBlock merged{};
  SampledBlock sampled;
  BlockTimes times_ns{};
  for (const auto& [id, index] : order_) {
    const MergeSource& source = *sources_[index];
    if (!source.counts() || !source.sample(block, sampled)) continue;
    if (id.self) {
      overlay_self(sampled, index, merged);
    } else if (config_.rule == MergeRule::kSafest) {
      merge_safest(sampled, index, merged);
    } else {
      merge_newest(sampled, index, merged, times_ns);
    }
  }
  return merged;
}

}  // namespace warren
