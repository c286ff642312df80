// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/conflict_watch.hpp"

#include <utility>

namespace warren {
namespace {

Eigen::Vector3d centre_of(const VoxelKey& block_low, std::uint32_t place, double resolution_m) {
  const VoxelKey in_block = place_of_morton9(place);
  return Eigen::Vector3d(block_low.x + in_block.x + 0.5, block_low.y + in_block.y + 0.5,
                         block_low.z + in_block.z + 0.5) *
         resolution_m;
}

}  // namespace

ConflictLevel level_of(double score) {
  if (score >= ConflictWatch::kQuarantine) return ConflictLevel::kMisleading;
  return score >= ConflictWatch::kAlign ? ConflictLevel::kAskew : ConflictLevel::kAligned;
}

std::optional<LayerId> ConflictWatch::advance(FleetMap& map) {
  if (map.own_layers().empty()) return std::nullopt;
  const Replica* layer = at_ ? map.loaded().replica(*at_) : nullptr;
  if (layer == nullptr) {
    layer = next_layer(map);
    if (layer == nullptr) return std::nullopt;
    next_ = 0;
    round_ = {};
  }
  at_ = layer->id();
  next_ = look_at(map, *layer);
  if (next_ != kOrdinalEnd) return std::nullopt;
  const LayerId done = *at_;
  const Replica* const following = next_layer(map);
  at_ = following == nullptr ? std::nullopt : std::optional(following->id());
  next_ = 0;
  const Round round = std::exchange(round_, {});
  if (round.known < kVoxelsMin) {
    scores_.erase(done);
    return std::nullopt;
  }
  scores_[done] = static_cast<double>(round.free) / static_cast<double>(round.known);
  return done;
}

std::optional<double> ConflictWatch::score(const LayerId& layer) const {
  const auto found = scores_.find(layer);
  return found == scores_.end() ? std::nullopt : std::optional(found->second);
}

BlockOrdinal ConflictWatch::look_at(FleetMap& map, const Replica& layer) {
  const auto lies = map.loaded().find(layer.id());
  const auto T_fleet_layer = lies ? lies->T_fleet_layer.checked() : std::nullopt;
  if (!T_fleet_layer || lies->unplaced) return kOrdinalEnd;
  const Eigen::Isometry3d T_merge_layer = map.T_merge_fleet() * *T_fleet_layer;
  const double resolution_m = layer.resolution().metres();
  std::size_t left = kRegionsPerTick;
  std::optional<RegionOrdinal> region;
  BlockOrdinal next = kOrdinalEnd;
  layer.for_each_changed({next_, kOrdinalEnd}, {}, [&](BlockOrdinal block, const LayerBlock& told) {
    if (region != region_of(block)) {
      if (left-- == 0) {
        next = block;
        return false;
      }
      region = region_of(block);
    }
    const VoxelKey low = first_voxel_of(block_key_of(block));
    told.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
      if (code.state() != VoxelState::kOccupied) return;
      const VoxelState known = map.own_state(T_merge_layer * centre_of(low, place, resolution_m));
      round_.known += known == VoxelState::kUnknown ? 0 : 1;
      round_.free += known == VoxelState::kFree ? 1 : 0;
    });
    return true;
  });
  return next;
}

// Round and round by their ids.
const Replica* ConflictWatch::next_layer(const FleetMap& map) const {
  const Replica* first = nullptr;
  const Replica* following = nullptr;
  map.loaded().for_each([&](const Replica& layer) {
    if (first == nullptr) first = &layer;
    if (following == nullptr && at_ && layer.id() > *at_) following = &layer;
  });
  return following != nullptr ? following : first;
}

}  // namespace warren
