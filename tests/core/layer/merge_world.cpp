// SPDX-License-Identifier: Apache-2.0
#include "tests/core/layer/merge_world.hpp"

#include <algorithm>
#include <numbers>

#include <doctest/doctest.h>

namespace warren::test {
namespace {

constexpr double kResolution_m = 0.1;

MergeSourceId other(std::uint32_t origin) { return {false, LayerId{origin, 1, 77}}; }
MergeSourceId own(std::uint32_t number) { return {true, LayerId{0, number, 0}}; }

}  // namespace

MergeWorld::MergeWorld(std::uint64_t seed, MergeRule rule, std::size_t cached_blocks)
    : random_(seed), map_({kResolution_m, rule, cached_blocks}) {
  const std::vector<double> resolutions_m = {0.1, 0.1, 0.1, 0.2, 0.05, 0.13};
  for (std::uint32_t origin = 1; origin <= 4; ++origin) {
    OracleLayer layer;
    layer.counts = false;
    layer.resolution_m = resolutions_m[below(random_, 6)];
    layer.T_merge_layer = random_pose(layer.resolution_m);
    layers_.emplace(other(origin), layer);
    foreign_[other(origin)].replica =
        std::make_unique<Replica>(other(origin).layer, kDefaultResolution);
  }
  for (std::uint32_t number = 1; number <= 2; ++number) {
    OracleLayer layer;
    layer.T_merge_layer = random_pose(kResolution_m);
    layers_.emplace(own(number), layer);
    own_[own(number)];
    REQUIRE(map_.open_self_layer(number, layer.T_merge_layer) == MergeResult::kDone);
  }
}

MergeSourceId MergeWorld::any_layer() {
  return std::next(layers_.begin(), below(random_, static_cast<std::uint32_t>(layers_.size())))
      ->first;
}

Eigen::Isometry3d MergeWorld::random_pose(double resolution_m) {
  const auto number = [this](double reach) {
    return (static_cast<double>(below(random_, 2001)) / 1000.0 - 1.0) * reach;
  };
  const auto voxels = [this](std::int32_t unit) {
    return static_cast<double>((static_cast<std::int32_t>(below(random_, 5)) - 2) * unit);
  };
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const std::uint32_t kind = below(random_, 5);
  const std::int32_t unit = kind == 0 ? kBlockEdge : 1;
  pose.translation() = Eigen::Vector3d(voxels(unit), voxels(unit), voxels(unit)) * resolution_m;
  if (kind <= 1) return pose;
  pose.translation() += Eigen::Vector3d(number(0.5), number(0.5), number(0.2));
  if (kind == 2) return pose;
  const double yaw_rad = number(std::numbers::pi);
  const double tilt_rad = kind == 3 ? 0.0 : number(0.3);
  pose.linear() = (Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

std::vector<CodedBlock> MergeWorld::random_blocks() {
  std::vector<CodedBlock> blocks;
  for (std::int32_t i = 0; i < 8; ++i) {
    if (!chance(random_, 25)) continue;
    const BlockKey key{(i & 1) - 1, (i >> 1 & 1) - 1, (i >> 2 & 1) - 1};
    const std::uint32_t percent = chance(random_, 20) ? 0 : 1 + below(random_, 20);
    blocks.push_back({ordinal_of(key), CodeBlock(random_codes(random_, percent))});
  }
  return blocks;
}

void MergeWorld::step() {
  const MergeSourceId id = any_layer();
  switch (below(random_, 6)) {
    case 0:
      return move(id);
    case 1:
      return add_or_remove(id);
    case 2:
      return retract_or_restore(id);
    default:
      return publish(id);
  }
}

void MergeWorld::take_in(OracleLayer& layer, const std::vector<CodedBlock>& blocks) {
  for (const CodedBlock& block : blocks) {
    const BlockKey key = block_key_of(block.block);
    std::erase_if(layer.voxels, [&](const auto& entry) { return block_of(entry.first) == key; });
    const VoxelKey first = first_voxel_of(key);
    block.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
      const VoxelKey at = place_of_morton9(place);
      layer.voxels.emplace(VoxelKey{first.x + at.x, first.y + at.y, first.z + at.z}, code);
    });
  }
}

void MergeWorld::publish(const MergeSourceId& id) {
  std::vector<CodedBlock> blocks = random_blocks();
  take_in(layers_.at(id), blocks);
  if (id.self) {
    for (const CodedBlock& block : blocks) own_[id][block.block] = block.codes;
    REQUIRE(map_.update_self(id.layer.number, blocks) == MergeResult::kDone);
    return;
  }
  Foreign& foreign = foreign_.at(id);
  const Revision before = foreign.replica->holdings().at(0);
  const Revision now = foreign.replica->publish(blocks);
  if (now == before) return;
  // Several layers may change at one time: then the lower id is to win.
  now_ns_ += chance(random_, 50) ? 1 : 0;
  foreign.replica->for_each_changed({}, before, [&](BlockOrdinal block, const LayerBlock&) {
    layers_.at(id).changed_ns[block_key_of(block)] = now_ns_;
    return true;
  });
  if (!foreign.merged) return;
  const bool time_first = chance(random_, 50);
  if (time_first) map_.note_time(id.layer, now, now_ns_);
  std::shuffle(blocks.begin(), blocks.end(), random_);
  for (const CodedBlock& block : blocks) map_.block_changed(id.layer, block.block);
  if (!time_first) map_.note_time(id.layer, now, now_ns_);
}

void MergeWorld::move(const MergeSourceId& id) {
  OracleLayer& layer = layers_.at(id);
  layer.T_merge_layer = random_pose(layer.resolution_m);
  const MergeResult result = id.self ? map_.move_self_layer(id.layer.number, layer.T_merge_layer)
                                     : map_.move_layer(id.layer, layer.T_merge_layer);
  const bool there = id.self || foreign_.at(id).merged;
  REQUIRE(result == (there ? MergeResult::kDone : MergeResult::kUnknownLayer));
}

void MergeWorld::add_to(MergeMap& map, const MergeSourceId& id) {
  const OracleLayer& layer = layers_.at(id);
  const Replica& replica = *foreign_.at(id).replica;
  REQUIRE(map.add_layer(id.layer, replica, layer.resolution_m, layer.T_merge_layer) ==
          MergeResult::kDone);
  replica.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    map.note_time(id.layer, found.history.latest(), layer.changed_ns.at(block_key_of(block)));
    return true;
  });
}

void MergeWorld::add_or_remove(const MergeSourceId& id) {
  if (id.self) return;
  Foreign& foreign = foreign_.at(id);
  if (foreign.merged) {
    REQUIRE(map_.remove_layer(id.layer) == MergeResult::kDone);
  } else {
    add_to(map_, id);
  }
  foreign.merged = !foreign.merged;
  layers_.at(id).counts = foreign.merged;
}

void MergeWorld::retract_or_restore(const MergeSourceId& id) {
  if (id.self || !foreign_.at(id).merged) return;
  bool& counts = layers_.at(id).counts;
  REQUIRE((counts ? map_.retract_layer(id.layer) : map_.restore_layer(id.layer)) ==
          MergeResult::kDone);
  counts = !counts;
}

MergedVoxels MergeWorld::merged_anew() {
  MergeMap anew({kResolution_m, map_.config().rule, 3});
  std::vector<MergeSourceId> order;
  for (const auto& layer : layers_) order.push_back(layer.first);
  std::shuffle(order.begin(), order.end(), random_);
  for (const MergeSourceId& id : order) {
    if (!id.self) {
      add_to(anew, id);
      continue;
    }
    anew.open_self_layer(id.layer.number, random_pose(kResolution_m));
    for (const auto& block : own_.at(id)) {
      const std::vector<CodedBlock> one = {{block.first, block.second}};
      anew.update_self(id.layer.number, one);
    }
    voxels_of(anew);
    anew.move_self_layer(id.layer.number, layers_.at(id).T_merge_layer);
  }
  for (const MergeSourceId& id : order) {
    if (id.self || layers_.at(id).counts) continue;
    voxels_of(anew);
    chance(random_, 50) ? anew.remove_layer(id.layer) : anew.retract_layer(id.layer);
  }
  return voxels_of(anew);
}

}  // namespace warren::test
