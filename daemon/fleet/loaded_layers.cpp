// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/loaded_layers.hpp"

#include <utility>

#include "core/layer/layer_counts.hpp"

namespace warren {
namespace {

const char* text_of(MergeResult result) {
  switch (result) {
    case MergeResult::kDone:
    case MergeResult::kUnknownLayer:
      break;
    case MergeResult::kKnownLayer:
      return "this layer is loaded already";
    case MergeResult::kBadPose:
      return "the layer would lie over a million km from this map, or its pose is not rigid";
    case MergeResult::kBadResolution:
      return "the layer's voxels are too much coarser or finer than this map's";
    case MergeResult::kTooManyLayers:
      return "too many layers are merged already";
  }
  return "the layer cannot be merged";
}

tl::unexpected<std::string> refused(std::string why) { return tl::unexpected(std::move(why)); }

constexpr const char* kNotLoaded = "no such layer is loaded";

// Turned about the vertical through its origin, then shifted.
Eigen::Isometry3d shifted(const Eigen::Isometry3d& T_fleet_layer, const LayerShift& shift) {
  Eigen::Isometry3d moved = T_fleet_layer;
  moved.linear() = Eigen::AngleAxisd(shift.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                   T_fleet_layer.linear();
  moved.translation() += shift.shift_fleet_m;
  return moved;
}

}  // namespace

LoadedLayers::Result LoadedLayers::add(Replica layer, std::string file) {
  const LayerId id = layer.id();
  if (layers_.contains(id)) return refused(text_of(MergeResult::kKnownLayer));
  if (layers_.size() == kLayersMax) return refused("too many layers are loaded already");
  const auto entry =
      layers_
          .try_emplace(id,
                       Held{std::move(layer), std::move(file), {}, RestSchedule(rest_after_ticks_)})
          .first;
  Held& held = entry->second;
  held.T_merge_layer = T_merge_fleet_ * held.replica.pose().T_fleet_layer();
  const MergeResult added =
      merge_.add_layer(id, held.replica, held.replica.resolution().metres(), held.T_merge_layer);
  if (added != MergeResult::kDone) {
    if (added == MergeResult::kBadPose) ++placements_refused_;
    layers_.erase(entry);
    return refused(text_of(added));
  }
  held.voxels = counts_of(held.replica);
  return report_of(held);
}

LoadedLayers::Result LoadedLayers::set_retracted(const LayerId& id, bool retracted) {
  Held* const held = find(id);
  if (held == nullptr) return refused(kNotLoaded);
  held->retracted = retracted;
  show(*held);
  return report_of(*held);
}

LoadedLayers::Result LoadedLayers::move(const LayerId& id, const LayerShift& shift) {
  Held* const held = find(id);
  if (held == nullptr) return refused(kNotLoaded);
  const Eigen::Isometry3d T_merge_layer =
      T_merge_fleet_ * shifted(held->replica.pose().T_fleet_layer(), shift);
  const MergeResult moved = merge_.move_layer(id, T_merge_layer);
  if (moved != MergeResult::kDone) {
    ++placements_refused_;
    return refused(text_of(moved));
  }
  held->shift = shift;
  held->T_merge_layer = T_merge_layer;
  held->out_of_reach = false;
  show(*held);
  return report_of(*held);
}

void LoadedLayers::place(const Eigen::Isometry3d& T_merge_fleet) {
  T_merge_fleet_ = T_merge_fleet;
  for (auto& [id, held] : layers_) {
    const Eigen::Isometry3d T_merge_layer =
        T_merge_fleet * shifted(held.replica.pose().T_fleet_layer(), held.shift);
    if (T_merge_layer.matrix() == held.T_merge_layer.matrix()) continue;
    held.T_merge_layer = T_merge_layer;
    held.out_of_reach = merge_.move_layer(id, T_merge_layer) != MergeResult::kDone;
    placements_refused_ += held.out_of_reach ? 1 : 0;
    show(held);
  }
}

std::size_t LoadedLayers::rest(std::size_t most) {
  std::size_t rested = 0;
  for (auto& [id, held] : layers_) {
    rested += rest_quiet_regions(held.replica, held.rest, most - rested);
  }
  return rested;
}

std::vector<LoadedLayer> LoadedLayers::list() const {
  std::vector<LoadedLayer> all;
  for (const auto& [id, held] : layers_) all.push_back(report_of(held));
  return all;
}

std::uint64_t LoadedLayers::poses_refused() const {
  std::uint64_t refused = placements_refused_;
  for (const auto& [id, held] : layers_) refused += held.replica.pose().refused();
  return refused;
}

LoadedLayers::Held* LoadedLayers::find(const LayerId& id) {
  const auto found = layers_.find(id);
  return found == layers_.end() ? nullptr : &found->second;
}

void LoadedLayers::show(const Held& held) {
  const LayerId& id = held.replica.id();
  held.retracted || held.out_of_reach ? merge_.retract_layer(id) : merge_.restore_layer(id);
}

LoadedLayer LoadedLayers::report_of(const Held& held) {
  const Eigen::Isometry3d T_fleet_layer = shifted(held.replica.pose().T_fleet_layer(), held.shift);
  return {held.replica.id(),       held.file,      held.replica.resolution(), held.voxels,
          Pose::of(T_fleet_layer), held.retracted, held.out_of_reach};
}

}  // namespace warren
