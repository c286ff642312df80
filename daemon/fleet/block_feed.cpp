// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/block_feed.hpp"

namespace warren {

void MergeFeed::for_each_changed(std::uint64_t since, const BlockBox& box, BlockOrdinal first,
                                 const Visitor& visit) const {
  map_.for_each_changed_block(since, box, first,
                              [&](const BlockKey& block) { return visit(ordinal_of(block)); });
}

void LayerFeed::for_each_changed(std::uint64_t since, const BlockBox& box, BlockOrdinal first,
                                 const Visitor& visit) const {
  const Revision from{static_cast<std::uint32_t>(since)};
  layer_.for_each_changed({first, kOrdinalEnd}, from, [&](BlockOrdinal block, const LayerBlock&) {
    return !box.index_of(block_key_of(block)) || visit(block);
  });
}

BlockVoxels LayerFeed::read(BlockOrdinal block) {
  BlockVoxels voxels{};
  layer_.codes_in_place(block).for_each_known(
      [&](std::uint32_t place, VoxelCode code) { voxels[place] = code; });
  return voxels;
}

}  // namespace warren
