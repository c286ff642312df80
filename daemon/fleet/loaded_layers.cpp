// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/loaded_layers.hpp"

#include <algorithm>
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

}  // namespace

tl::expected<LoadedLayers::Held*, std::string> LoadedLayers::add(Held held) {
  const LayerId id = held.replica->id();
  if (layers_.contains(id)) return refused(text_of(MergeResult::kKnownLayer));
  const Replica& replica = *held.replica;
  held.T_merge_layer = T_merge_fleet_ * replica.pose().T_fleet_layer();
  const double resolution_m = replica.resolution().metres();
  MergeResult added = merge_.add_layer(id, replica, resolution_m, held.T_merge_layer);
  if (added == MergeResult::kBadPose) ++placements_refused_;
  if (added == MergeResult::kBadPose && !held.loaded) {
    // A copy may come within reach yet.
    held.out_of_reach = true;
    added = merge_.add_layer(id, replica, resolution_m, Eigen::Isometry3d::Identity());
  }
  if (added != MergeResult::kDone) return refused(text_of(added));
  return &layers_.try_emplace(id, std::move(held)).first->second;
}

LoadedLayers::Result LoadedLayers::add(Replica layer, std::string file) {
  const auto from_file = [](const auto& entry) { return entry.second.loaded != nullptr; };
  if (std::count_if(layers_.begin(), layers_.end(), from_file) >=
      static_cast<std::ptrdiff_t>(kLayersMax)) {
    return refused("too many layers are loaded already");
  }
  Held held{.rest = RestSchedule(rest_after_ticks_)};
  held.loaded = std::make_unique<Replica>(std::move(layer));
  held.replica = held.loaded.get();
  held.file = std::move(file);
  const auto added = add(std::move(held));
  if (!added) return tl::unexpected(added.error());
  (*added)->voxels = counts_of(*(*added)->replica);
  return report_of(**added);
}

LoadedLayers::Result LoadedLayers::add_copy(Replica& copy) {
  Held held{.rest = RestSchedule(rest_after_ticks_)};
  held.replica = &copy;
  held.unplaced = lacks_pose(held);
  const auto added = add(std::move(held));
  if (!added) return tl::unexpected(added.error());
  show(**added);
  copy.on_change([this, id = copy.id()](BlockOrdinal block) { merge_.block_changed(id, block); });
  return report_of(**added);
}

bool LoadedLayers::lacks_pose(const Held& held) {
  return !held.loaded && held.replica->pose().origin().revision == 0;
}

LoadedLayers::Result LoadedLayers::set_retracted(const LayerId& id, bool retracted) {
  Held* const held = find_held(id);
  if (held == nullptr) return refused(kNotLoaded);
  held->retracted = retracted;
  held->voxels = counts_of(*held->replica);
  show(*held);
  return report_of(*held);
}

void LoadedLayers::set_retracted_by_fleet(const LayerId& id, bool retracted) {
  Held* const held = find_held(id);
  if (held == nullptr || held->retracted_by_fleet == retracted) return;
  held->retracted_by_fleet = retracted;
  show(*held);
}

LoadedLayers::Result LoadedLayers::move(const LayerId& id, const LayerShift& shift) {
  Held* const held = find_held(id);
  if (held == nullptr) return refused(kNotLoaded);
  const Eigen::Isometry3d T_merge_layer =
      T_merge_fleet_ * shifted(held->replica->pose().T_fleet_layer(), shift);
  const MergeResult moved = merge_.move_layer(id, T_merge_layer);
  if (moved != MergeResult::kDone) {
    ++placements_refused_;
    return refused(text_of(moved));
  }
  held->shift = shift;
  held->T_merge_layer = T_merge_layer;
  held->out_of_reach = false;
  held->voxels = counts_of(*held->replica);
  show(*held);
  return report_of(*held);
}

void LoadedLayers::place(const Eigen::Isometry3d& T_merge_fleet) {
  T_merge_fleet_ = T_merge_fleet;
  for (auto& [id, held] : layers_) place(held);
}

void LoadedLayers::place(Held& held) {
  const Eigen::Isometry3d T_merge_layer =
      T_merge_fleet_ * shifted(held.replica->pose().T_fleet_layer(), held.shift);
  const bool unplaced = lacks_pose(held);
  const bool stays = T_merge_layer.matrix() == held.T_merge_layer.matrix();
  if (stays && unplaced == held.unplaced) return;
  held.unplaced = unplaced;
  if (!stays) {
    held.T_merge_layer = T_merge_layer;
    held.out_of_reach = merge_.move_layer(held.replica->id(), T_merge_layer) != MergeResult::kDone;
    placements_refused_ += held.out_of_reach ? 1 : 0;
  }
  show(held);
}

std::size_t LoadedLayers::rest(std::size_t most) {
  std::size_t rested = 0;
  for (auto& [id, held] : layers_) {
    rested += rest_quiet_regions(*held.replica, held.rest, most - rested);
  }
  return rested;
}

std::vector<LoadedLayer> LoadedLayers::list() const {
  std::vector<LoadedLayer> all;
  for (const auto& [id, held] : layers_) {
    if (held.loaded) all.push_back(report_of(held));
  }
  return all;
}

std::optional<LoadedLayer> LoadedLayers::find(const LayerId& id) const {
  const auto found = layers_.find(id);
  return found == layers_.end() ? std::nullopt : std::optional(report_of(found->second));
}

const Replica* LoadedLayers::replica(const LayerId& id) const {
  const auto found = layers_.find(id);
  return found == layers_.end() ? nullptr : found->second.replica;
}

std::uint64_t LoadedLayers::poses_refused() const {
  std::uint64_t refused = placements_refused_;
  for (const auto& [id, held] : layers_) refused += held.replica->pose().refused();
  return refused;
}

LoadedLayers::Held* LoadedLayers::find_held(const LayerId& id) {
  const auto found = layers_.find(id);
  return found == layers_.end() ? nullptr : &found->second;
}

void LoadedLayers::show(const Held& held) {
  const LayerId& id = held.replica->id();
  const bool left_out =
      held.retracted || held.retracted_by_fleet || held.out_of_reach || held.unplaced;
  left_out ? merge_.retract_layer(id) : merge_.restore_layer(id);
}

LoadedLayer LoadedLayers::report_of(const Held& held) {
  const Replica& replica = *held.replica;
  const Eigen::Isometry3d T_fleet_layer = shifted(replica.pose().T_fleet_layer(), held.shift);
  const bool retracted = held.retracted || held.retracted_by_fleet;
  return {replica.id(),
          held.file,
          replica.resolution(),
          held.voxels,
          Pose::of(T_fleet_layer),
          retracted,
          held.retracted_by_fleet,
          held.out_of_reach,
          held.unplaced};
}

}  // namespace warren
