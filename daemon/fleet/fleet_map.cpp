// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet_map.hpp"

#include <utility>

#include "core/exchange/layer_file.hpp"
#include "core/layer/layer_counts.hpp"
#include "core/layer/merge_view.hpp"

namespace warren {
namespace {

std::span<const CodedBlock> blocks_of(std::span<const LayerChanges> changes, std::uint32_t number) {
  for (const LayerChanges& layer : changes) {
    if (layer.number == number) return layer.blocks;
  }
  return {};
}

}  // namespace

void FleetMap::tick(std::span<const LayerChanges> changes) {
  ++ticks_;
  for (const LayerChanges& layer : changes) {
    OwnLayer& own = own_layer(layer);
    if (const auto T_fleet_map = layer.T_fleet_map.checked()) own.move(*T_fleet_map);
    merge_.update_self(layer.number, layer.blocks);
  }
  for (auto& [number, layer] : own_) layer.tick(blocks_of(changes, number));
  rest_quiet_layers();
  if (changes.empty()) return;
  gravity_map_ = changes.back().gravity_map;
  position_map_ = changes.back().position_map;
  place_layers();
}

void FleetMap::rest_quiet_layers() {
  std::size_t left = kRegionsRestedPerTick;
  for (auto& [number, layer] : own_) left -= layer.rest(left);
  loaded_.rest(left);
}

std::optional<FlushReport> FleetMap::flush() {
  std::uint64_t blocks = 0;
  for (auto& [number, layer] : own_) blocks += layer.flush();
  const Replica* const layer = current();
  if (layer == nullptr) return std::nullopt;
  return FlushReport{layer->id(), layer->holdings().at(0), blocks};
}

template <typename... Args>
OwnLayer& FleetMap::open(std::uint32_t number, const Eigen::Vector3d& origin_map, Args&&... args) {
  merge_origin_map_ = origin_map;
  merge_.open_self_layer(number, Eigen::Isometry3d::Identity());
  OwnLayer& opened = own_.try_emplace(number, std::forward<Args>(args)...).first->second;
  opened_(opened);
  return opened;
}

OwnLayer& FleetMap::own_layer(const LayerChanges& changes) {
  const auto found = own_.find(changes.number);
  if (found != own_.end()) return found->second;
  const LayerId id{config_.origin, changes.number, draw_incarnation_()};
  const Eigen::Vector3d origin_map = changes.origin.position_map(config_.resolution.metres());
  return open(changes.number, origin_map, id, config_.resolution, origin_map, config_.publishing,
              config_.rest_after_ticks);
}

void FleetMap::restore(std::vector<StoredOwnLayer>&& layers) {
  for (StoredOwnLayer& layer : layers) {
    const std::uint32_t number = layer.layer.id().number;
    const Eigen::Vector3d origin_map = layer.origin.position_map(config_.resolution.metres());
    open(number, origin_map, std::move(layer), config_.publishing, config_.rest_after_ticks);
  }
}

bool FleetMap::correct_own(const LayerId& layer, const WrittenPose& correction) {
  const auto found = own_.find(layer.number);
  if (found == own_.end() || found->second.layer().id() != layer) return false;
  const bool moved = found->second.correct(correction);
  if (moved) place_layers();
  return moved;
}

std::optional<Eigen::Vector3d> FleetMap::position_layer() const {
  if (own_.empty() || !position_map_) return std::nullopt;
  return own_.rbegin()->second.T_map_layer().inverse() * *position_map_;
}

std::optional<Eigen::Vector3d> FleetMap::position_fleet() const {
  if (own_.empty() || !position_map_) return std::nullopt;
  return own_.rbegin()->second.T_fleet_map() * *position_map_;
}

Eigen::Isometry3d FleetMap::T_merge_fleet() const {
  const Eigen::Translation3d T_merge_map(-merge_origin_map_);
  if (own_.empty()) return Eigen::Isometry3d(T_merge_map);
  return T_merge_map * own_.rbegin()->second.T_fleet_map().inverse();
}

VoxelState FleetMap::own_state(const Eigen::Vector3d& position_merge) {
  const MergedVoxel voxel = merge_.voxel(Point3f{static_cast<float>(position_merge.x()),
                                                 static_cast<float>(position_merge.y()),
                                                 static_cast<float>(position_merge.z())});
  const bool own = voxel.source != kNoSource && merge_.source(voxel.source).self;
  return own ? voxel.code.state() : VoxelState::kUnknown;
}

Eigen::Isometry3d FleetMap::T_merge_own(const OwnLayer& layer) const {
  const Eigen::Isometry3d& T_fleet_map = own_.rbegin()->second.T_fleet_map();
  // In one and the same map frame this is a shift to the last bit, so that a correction of where
  // that frame lies in the fleet's moves nothing.
  if (layer.T_fleet_map().matrix() == T_fleet_map.matrix()) {
    return Eigen::Translation3d(-merge_origin_map_) * Eigen::Isometry3d(layer.T_map_layer());
  }
  return T_merge_fleet() * layer.T_fleet_layer();
}

void FleetMap::place_layers() {
  for (const auto& [number, layer] : own_) {
    const Eigen::Isometry3d T_merge_layer = T_merge_own(layer);
    const auto [placed, is_new] = T_merge_own_.try_emplace(number, T_merge_layer);
    if (!is_new && placed->second.matrix() == T_merge_layer.matrix()) continue;
    placed->second = T_merge_layer;
    if (merge_.move_self_layer(number, T_merge_layer) == MergeResult::kDone) {
      merge_.restore_self_layer(number);
    } else {
      merge_.retract_self_layer(number);
      ++placements_refused_;
    }
  }
  loaded_.place(T_merge_fleet());
}

LoadedLayers::Result FleetMap::load(Replica layer, std::string file) {
  return loaded_.add(std::move(layer), std::move(file));
}

tl::expected<GroundAnswer, std::string> FleetMap::ground(const GroundQuestion& question) {
  return answer_ground(MergeView(merge_), merge_origin_map_, gravity_map_, question);
}

tl::expected<CellsAnswer, std::string> FleetMap::cells(const CellsQuestion& question) {
  if (!has_map(question.source)) return tl::unexpected(std::string(kNoMapYet));
  const bool on_merge = question.source == MapSource::kMerge;
  const double resolution_m = config_.resolution.metres();
  const Eigen::Vector3d origin = origin_map(question.source);
  const auto grid = grid_of(question, resolution_m, origin);
  if (!grid) return tl::unexpected(grid.error());
  return CellsAnswer{resolution_m, origin, grid->level(),
                     on_merge ? cells_of(merge_, *grid) : cells_of(*current(), *grid)};
}

std::shared_ptr<MergedSnapshot> FleetMap::merged_snapshot() {
  if (own_.empty() && loaded_.size() == 0) return nullptr;
  return std::make_shared<MergedSnapshot>(snapshot_of(merge_, merge_origin_map_));
}

const Replica* FleetMap::current() const {
  return own_.empty() ? nullptr : &own_.rbegin()->second.layer();
}

PublishingReport FleetMap::report() const {
  PublishingReport report;
  report.layers = static_cast<std::uint32_t>(own_.size());
  report.memory = memory();
  report.loaded = loaded_.list();
  report.poses_refused = loaded_.poses_refused() + placements_refused_;
  report.ticks = ticks_;
  for (const auto& [number, layer] : own_) {
    report.traffic += layer.traffic();
    report.blocks_held_back += layer.blocks_held_back();
    report.poses_refused += layer.layer().pose().refused();
  }
  if (const Replica* const layer = current()) {
    report.current = {layer->id(), layer->holdings().at(0), layer->digest().root()};
  }
  return report;
}

LayerMemory FleetMap::memory() const {
  LayerMemory memory;
  const auto add = [&](const Replica& layer, std::size_t& bytes) {
    bytes += layer.memory_bytes();
    memory.at_rest_bytes += layer.bytes_at_rest();
    memory.regions += layer.regions();
    memory.regions_at_rest += layer.regions() - layer.regions_awake();
  };
  for (const auto& [number, layer] : own_) {
    add(layer.layer(), memory.own_layers_bytes);
    memory.own_layers_bytes += layer.held_back_bytes();
  }
  loaded_.for_each([&](const Replica& layer) { add(layer, memory.loaded_layers_bytes); });
  memory.merge_map_bytes = merge_.memory_bytes();
  return memory;
}

std::optional<LayerDiff> FleetMap::diff(const KeyInterval& keys, Revision from) const {
  const Replica* const layer = current();
  if (layer == nullptr) return std::nullopt;
  LayerDiff diff{layer->id(), layer->resolution(), layer->holdings().at(0), {}, kOrdinalEnd};
  std::size_t bytes = 0;
  for_each_packet(*layer, {keys, from, config_.publishing.packet_bytes}, [&](DiffPacket& packet) {
    if (bytes + packet.bytes.size() > kDiffBytesMax) {
      diff.next_key = packet.claim.keys.first;
      return false;
    }
    bytes += packet.bytes.size();
    diff.packets.push_back(std::move(packet.bytes));
    return true;
  });
  return diff;
}

std::optional<EncodedLayer> FleetMap::encoded_layer() const {
  const Replica* const layer = current();
  if (layer == nullptr) return std::nullopt;
  return encoded(*layer);
}

EncodedLayer FleetMap::encoded(const Replica& layer) {
  const MapCounts known = counts_of(layer);
  return {encode_layer(layer), known.free + known.occupied};
}

}  // namespace warren
