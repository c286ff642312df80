// SPDX-License-Identifier: Apache-2.0
// What planners ask a FleetMap for.
#include "daemon/fleet/fleet_map.hpp"

namespace warren {

Eigen::Vector3d FleetMap::origin_map(MapSource source) const {
  return source == MapSource::kMerge ? merge_origin_map_
                                     : own_.rbegin()->second.T_map_layer().translation();
}

tl::expected<BlocksAnswer, std::string> FleetMap::blocks(const BlocksQuestion& question) {
  if (!has_map(question.source)) return tl::unexpected(std::string(kNoMapYet));
  BlocksAnswer answer;
  answer.resolution_m = config_.resolution.metres();
  answer.origin_map = origin_map(question.source);
  answer.position_map = position_map_;
  std::uint64_t frame = 0;
  if (!own_.empty()) {
    const OwnLayer& newest = own_.rbegin()->second;
    answer.T_fleet_map = Pose::of(newest.T_fleet_map());
    frame = newest.layer().id().incarnation;
  }
  const BlockBox box = blocks_in(question.box, answer.resolution_m, answer.origin_map);
  if (question.source == MapSource::kMerge) {
    MergeFeed feed(merge_);
    tell_blocks(feed, frame, box, question, answer);
  } else {
    LayerFeed feed(*current());
    tell_blocks(feed, frame, box, question, answer);
  }
  return answer;
}

tl::expected<RaysAnswer, std::string> FleetMap::rays(const RaysQuestion& question) {
  if (!has_map(question.source)) return tl::unexpected(std::string(kNoMapYet));
  const RayPlace place{Lattice(config_.resolution.metres()), origin_map(question.source)};
  if (question.source == MapSource::kMerge) {
    return cast_rays(place, question, [&](const VoxelKey& key) { return merge_.voxel(key).code; });
  }
  return cast_rays(place, question, LayerVoxels(*current()));
}

}  // namespace warren
