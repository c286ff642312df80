// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/layered_map.hpp"

#include <algorithm>
#include <cmath>

#include "core/layer/publisher.hpp"

namespace warren {
namespace {

std::optional<Eigen::Vector3d> sensor_position_map(const Scan& scan) {
  const auto T_map_base = scan.T_map_base.checked();
  const auto T_base_sensor = scan.T_base_sensor.checked();
  if (!T_map_base || !T_base_sensor) return std::nullopt;
  return (*T_map_base * *T_base_sensor).translation();
}

Eigen::Vector3d corner_map_m(const Layer& layer, const VoxelKey& key, double resolution_m) {
  return layer.origin.position_map(resolution_m) +
         Eigen::Vector3d(key.x, key.y, key.z) * resolution_m;
}

// Layer and map frame differ by a shift alone.
Point3f in_layer(const Eigen::Vector3d& direction_map) {
  return {static_cast<float>(direction_map.x()), static_cast<float>(direction_map.y()),
          static_cast<float>(direction_map.z())};
}

MapInfoReport::Current info_of(const Layer& layer, double resolution_m) {
  MapInfoReport::Current info;
  info.frame_epoch = layer.frame_epoch;
  info.scans = layer.scans;
  info.counts = layer.voxels.counts();
  info.costs = layer.voxels.cost_counts();
  info.origin_map_m = layer.origin.position_map(resolution_m);
  info.T_fleet_map = layer.T_fleet_map;
  if (const auto box = layer.voxels.bounds()) {
    const VoxelKey past{box->high.x + 1, box->high.y + 1, box->high.z + 1};
    info.known = {corner_map_m(layer, box->low, resolution_m),
                  corner_map_m(layer, past, resolution_m)};
  }
  return info;
}

}  // namespace

tl::unexpected<std::string> LayeredMap::reject(Rejection reason) {
  ++count_of(rejected_, reason);
  return tl::unexpected(std::string(name_of(reason)));
}

tl::expected<std::uint64_t, std::string> LayeredMap::integrate(Scan scan, std::uint64_t frame_epoch,
                                                               const SensorFilter& filter) {
  if (!normalise(scan.gravity_map)) return reject(Rejection::kBadGravity);
  const auto layer = layer_for(scan, frame_epoch);
  if (!layer) return tl::unexpected(layer.error());
  Layer& into = **layer;

  RejectionCounts rejected{};
  const auto prepared =
      preparer_.prepare(scan, filter, into.origin, config_.resolution_m, rejected);
  if (!prepared) return reject(Rejection::kOriginOutsideKeySpace);
  const IntegrationReport report =
      pipeline_.run(*prepared, in_layer(scan.gravity_map), into.voxels).integration;
  ++into.scans;
  into.gravity_map = scan.gravity_map;
  into.position_map = sensor_position_map(scan);

  for (std::size_t i = 0; i < kRejectionCount; ++i)
    rejected_[i] += rejected[i] + report.rejected[i];
  return report.points_used;
}

tl::expected<Layer*, std::string> LayeredMap::layer_for(const Scan& scan,
                                                        std::uint64_t frame_epoch) {
  const auto found = std::find_if(layers_.begin(), layers_.end(), [&](const auto& layer) {
    return layer->frame_epoch == frame_epoch;
  });
  if (found == layers_.end()) return open_layer(scan, frame_epoch);
  if (found->get() != layers_.back().get()) {
    return reject(Rejection::kFrameEpochOver);
  }
  if (!sensor_position_map(scan)) return reject(Rejection::kBadPose);
  return found->get();
}

tl::expected<Layer*, std::string> LayeredMap::open_layer(const Scan& scan,
                                                         std::uint64_t frame_epoch) {
  const auto position = sensor_position_map(scan);
  if (!position) return reject(Rejection::kBadPose);
  const auto origin = LayerOrigin::snapped(*position, config_.resolution_m);
  if (!origin) return reject(Rejection::kOriginOutsideKeySpace);
  if (layers_.size() >= kMaxLayers) {
    return reject(Rejection::kTooManyFrameEpochs);
  }
  // A copy leaves the scratch memory of integration behind: frozen layers need none.
  if (!layers_.empty()) layers_.back()->voxels = SelfMap(layers_.back()->voxels);
  layers_.push_back(std::make_unique<Layer>(Layer{
      next_number_, frame_epoch, *origin, SelfMap(config_), 0, T_fleet_map_, scan.gravity_map}));
  ++next_number_;
  return layers_.back().get();
}

bool LayeredMap::update_pose(const PoseUpdateMessage& update) {
  if (layers_.empty() || layers_.back()->frame_epoch != update.frame_epoch) return false;
  if (!update.T_fleet_map.checked()) return false;
  layers_.back()->T_fleet_map = {update.T_fleet_map.translation,
                                 update.T_fleet_map.rotation.normalized()};
  return true;
}

MapInfoReport LayeredMap::info() const {
  MapInfoReport info;
  info.resolution_m = config_.resolution_m;
  info.layers = static_cast<std::uint32_t>(layers_.size());
  for (const auto& layer : layers_) info.memory_bytes += layer->voxels.memory_bytes();
  if (const Layer* const layer = current()) info.current = info_of(*layer, config_.resolution_m);
  return info;
}

tl::expected<GroundAnswer, std::string> LayeredMap::ground(const GroundQuestion& question) const {
  const Layer* const layer = current();
  if (layer == nullptr) return tl::unexpected(std::string(kNoMapYet));
  return answer_ground(SelfMapView(layer->voxels), layer->origin.position_map(config_.resolution_m),
                       layer->gravity_map, question);
}

void LayeredMap::restore(StoredMap stored) {
  next_number_ = stored.next_number;
  for (auto& [head, voxels] : stored.layers) {
    layers_.push_back(
        std::make_unique<Layer>(Layer{head.number, head.frame_epoch, head.origin, std::move(voxels),
                                      head.scans, head.T_fleet_map, head.gravity_map}));
    layers_.back()->stored = head.cursor;
  }
}

SelfLayerWrite LayeredMap::write_of(Layer& layer) const {
  SelfLayerWrite write{{layer.number, layer.frame_epoch, layer.origin, config_, layer.scans,
                        layer.voxels.cursor(), layer.T_fleet_map, layer.gravity_map},
                       {}};
  for (const BlockKey& key : layer.voxels.blocks_changed_since(layer.stored)) {
    if (auto block = layer.voxels.export_block(key)) write.blocks.push_back(std::move(*block));
  }
  layer.stored = layer.voxels.cursor();
  return write;
}

std::vector<LayerChanges> LayeredMap::take_changes() {
  std::vector<LayerChanges> changes;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    Layer& layer = *layers_[i];
    const std::uint32_t now = layer.voxels.cursor();
    const bool is_current = i + 1 == layers_.size();
    if (layer.handed_over == now && !is_current) continue;
    changes.push_back({layer.number, layer.origin, layer.T_fleet_map, layer.gravity_map,
                       blocks_changed_since(layer.voxels, layer.handed_over), layer.position_map});
    if (is_stored_) changes.back().to_store = write_of(layer);
    layer.handed_over = now;
  }
  return changes;
}

std::shared_ptr<const MapSnapshot> LayeredMap::snapshot() const {
  const Layer* const layer = current();
  if (layer == nullptr) return nullptr;
  return std::make_shared<const MapSnapshot>(MapSnapshot{layer->origin, layer->voxels});
}

}  // namespace warren
