// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "daemon/fleet/fleet_map.hpp"

// A fleet thread's map and what it is fed, in blocks that one can count by hand.
namespace warren::test {

inline const LayerOrigin kFarOrigin{8'000'000, -16'000'000, 8};

inline FleetMap fleet_map(SenderRules rules = {}, std::uint32_t rest_after_ticks = 60) {
  std::uint64_t drawn = 0;
  return FleetMap({7, Resolution{}, {rules, 1200, 3}, rest_after_ticks},
                  [drawn]() mutable { return ++drawn; });
}

// A floor, one voxel thick, over one block: all of it occupied, with this cost.
inline CodedBlock floor_block(const BlockKey& key, CostCode cost) {
  BlockCodes codes;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelKey in_block = place_of_morton9(place);
    codes.set(place, in_block.z == 0 ? VoxelCode::occupied(cost, false) : VoxelCode::free());
  }
  return {ordinal_of(key), CodeBlock(codes)};
}

inline CodedBlock one_free_voxel(const BlockKey& key) {
  BlockCodes codes;
  codes.set(0, VoxelCode::free());
  return {ordinal_of(key), CodeBlock(codes)};
}

inline LayerChanges changes_of(std::vector<CodedBlock> blocks, std::uint32_t number = 0) {
  return {number, kFarOrigin, {}, {0.0, 0.0, -1.0}, std::move(blocks)};
}

inline void tick(FleetMap& fleet, std::vector<CodedBlock> blocks) {
  const std::vector<LayerChanges> changes{changes_of(std::move(blocks))};
  fleet.tick(changes);
}

inline void follow(const FleetMap& fleet, Replica& copy) {
  const auto diff = fleet.diff({}, copy.holdings().lowest({}));
  REQUIRE(diff.has_value());
  REQUIRE(diff->next_key == kOrdinalEnd);
  for (const auto& packet : diff->packets) {
    REQUIRE(copy.apply(diff->id, packet) == ApplyResult::kApplied);
  }
}

// In the middle of block (x, 0, 0) of the layer, on its floor.
inline GroundQuestion question_at(std::int32_t block_x) {
  GroundQuestion question;
  question.source = MapSource::kMerge;
  question.T_map_base.translation =
      kFarOrigin.position_map(0.1) + Eigen::Vector3d(0.8 * block_x + 0.4, 0.4, 0.1);
  question.footprint = {0.3, 0.3};
  return question;
}

inline Replica earlier_layer(const std::vector<CodedBlock>& blocks) {
  Replica layer(LayerId{99, 1, 5}, kDefaultResolution);
  layer.publish(blocks);
  const Eigen::Vector3d origin = kFarOrigin.position_map(0.1);
  layer.pose().update_origin({1, 99, {origin, Eigen::Quaterniond::Identity()}});
  return layer;
}

}  // namespace warren::test
