// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/response.hpp"

#include "core/layer/hash_text.hpp"
#include "daemon/control/encoded_fields.hpp"
#include "proto/framing.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

void add_pose(const Pose& pose, google::protobuf::RepeatedField<double>& field) {
  add_vector(pose.translation, field);
  for (const double q : pose.rotation.coeffs()) field.Add(q);  // Eigen's order: x y z w
}

void fill(const MapInfoReport::Current& current, control::MapInfo& info) {
  info.set_frame_epoch(current.frame_epoch);
  info.set_scans(current.scans);
  info.set_voxels_free(current.counts.free);
  info.set_voxels_occupied(current.counts.occupied);
  info.set_blocks(current.counts.blocks);
  info.set_cost_no_data(current.costs.no_data);
  info.set_cost_up_to_0p10(current.costs.up_to_0p10);
  info.set_cost_up_to_0p20(current.costs.up_to_0p20);
  info.set_cost_above_0p20(current.costs.above_0p20);
  add_vector(current.origin_map_m, *info.mutable_origin_map_m());
  add_pose(current.T_fleet_map, *info.mutable_t_fleet_map());
  if (!current.known) return;
  add_vector(current.known->low_map_m, *info.mutable_low_map_m());
  add_vector(current.known->high_map_m, *info.mutable_high_map_m());
}

void fill(const MapInfoReport& report, control::MapInfo& info) {
  info.set_resolution_m(report.resolution_m);
  info.set_memory_bytes(report.memory_bytes);
  info.set_layers(report.layers);
  if (report.current) fill(*report.current, info);
}

void fill(const IngestStatus& ingest, control::Status& status) {
  status.set_clients(ingest.clients);
  status.set_replies_dropped(ingest.replies_dropped);
  for (std::size_t i = 0; i < kRefusalCount; ++i) {
    add_count(name_of(static_cast<Refusal>(i)), ingest.refused[i],
              *status.mutable_refused_frames());
  }
  for (const auto& [name, counts] : ingest.sensors) {
    auto* const sensor = status.add_sensors();
    sensor->set_name(name);
    sensor->set_received(counts.received);
    sensor->set_taken(counts.taken);
    sensor->set_dropped_overload(counts.dropped_overload);
    sensor->set_dropped_out_of_order(counts.dropped_out_of_order);
    sensor->set_rejected(counts.rejected);
  }
}

void fill(const MapperStatus& mapper, control::Status& status) {
  for (std::size_t i = 0; i < kRejectionCount; ++i) {
    add_count(name_of(static_cast<Rejection>(i)), mapper.rejected_points[i],
              *status.mutable_rejected_points());
  }
  fill(mapper.map, *status.mutable_map());
  status.set_integrate_cpu_ms_mean(mapper.integrate_cpu_ms_mean);
  status.set_integrate_cpu_ms_max(mapper.integrate_cpu_ms_max);
}

void fill(const PublishingReport& report, control::Publishing& publishing) {
  publishing.set_layers(report.layers);
  publishing.set_ticks(report.ticks);
  publishing.set_ticks_late(report.ticks_late);
  publishing.set_packets(report.traffic.packets);
  publishing.set_bytes(report.traffic.bytes);
  publishing.set_bytes_of_last_tick(report.traffic.bytes_of_last_tick);
  publishing.set_blocks_held_back(report.blocks_held_back);
  if (!report.current) return;
  fill(report.current->id, *publishing.mutable_layer());
  publishing.set_revision(report.current->revision.number);
  publishing.set_digest(hex_of(report.current->digest));
}

void fill(const LayerMemory& memory, control::LayerMemory& message) {
  message.set_own_layers_bytes(memory.own_layers_bytes);
  message.set_loaded_layers_bytes(memory.loaded_layers_bytes);
  message.set_merge_map_bytes(memory.merge_map_bytes);
  message.set_at_rest_bytes(memory.at_rest_bytes);
  message.set_regions(memory.regions);
  message.set_regions_at_rest(memory.regions_at_rest);
}

void fill(const LoadedLayer& layer, control::LoadedLayer& message) {
  fill(layer.id, *message.mutable_layer());
  message.set_file(layer.file);
  message.set_resolution_m(layer.resolution.metres());
  message.set_voxels_free(layer.voxels.free);
  message.set_voxels_occupied(layer.voxels.occupied);
  message.set_retracted(layer.retracted);
  message.set_out_of_reach(layer.out_of_reach);
  message.set_unplaced(layer.unplaced);
  add_pose(layer.T_fleet_layer, *message.mutable_t_fleet_layer());
}

void fill(const StoreStatus& store, control::StoreStatus& message) {
  if (store.health.failing) message.set_failing(store.health.failing->text);
  message.set_batches_queued(store.batches_queued);
  message.set_bytes_queued(store.bytes_queued);
  message.set_transactions(store.transactions);
  message.set_transactions_failed(store.transactions_failed);
  for (std::size_t i = 0; i < kBatchResults; ++i) {
    const auto result = static_cast<BatchResult>(i);
    add_count(text_of(result), store.results[i], *message.mutable_results());
  }
  message.set_layers_evicted(store.layers_evicted);
  message.set_messages_evicted(store.items_evicted);
  message.set_file_bytes(store.usage.file_bytes);
  message.set_used_bytes(store.usage.used_bytes);
  message.set_log_bytes(store.usage.log_bytes);
  message.set_checkpoints_failed(store.usage.checkpoints_failed);
}

}  // namespace

std::string encode_status(const StatusReport& report) {
  control::Response response;
  auto& status = *response.mutable_status();
  status.set_node(report.node);
  status.set_version(report.version);
  status.set_uptime_s(report.uptime_s);
  status.set_queue_scans(static_cast<std::uint32_t>(report.queue.scans));
  status.set_queue_capacity(static_cast<std::uint32_t>(report.queue.capacity));
  fill(report.ingest, status);
  fill(report.mapper, status);
  fill(report.publishing, *status.mutable_publishing());
  fill(report.publishing.memory, *status.mutable_layer_memory());
  status.set_layers_loaded(static_cast<std::uint32_t>(report.publishing.loaded.size()));
  for (const LoadedLayer& layer : report.publishing.loaded) fill(layer, *status.add_loaded());
  status.set_poses_refused(report.publishing.poses_refused);
  if (report.store) fill(*report.store, *status.mutable_store());
  return framed(response.SerializeAsString());
}

std::string encode_map_info(const MapInfoReport& info) {
  control::Response response;
  fill(info, *response.mutable_map_info());
  return framed(response.SerializeAsString());
}

std::string encode_map_saved(const std::string& path, const SaveReport& report) {
  control::Response response;
  auto& saved = *response.mutable_map_saved();
  saved.set_path(path);
  saved.set_format(report.format);
  saved.set_bytes(report.bytes);
  saved.set_voxels(report.voxels);
  saved.set_note(report.note);
  return framed(response.SerializeAsString());
}

std::string encode_ground(const GroundAnswer& answer) {
  const GroundReport& report = answer.ground;
  control::Response response;
  auto& ground = *response.mutable_ground();
  ground.set_columns(report.columns);
  ground.set_columns_with_ground(report.columns_with_ground);
  ground.set_columns_with_cost(report.columns_with_cost);
  if (report.mean_cost) ground.set_mean_cost(*report.mean_cost);
  if (report.max_cost) ground.set_max_cost(*report.max_cost);
  ground.set_unknown_share(report.unknown_share);
  ground.set_stairs_share(report.stairs_share);
  ground.set_step_m(report.step_m);
  ground.set_validity(name_of(answer.validity));
  ground.set_valid(is_valid(answer.validity));
  return framed(response.SerializeAsString());
}

std::string encode_layer_diff(const LayerDiff& diff) {
  control::Response response;
  auto& message = *response.mutable_layer_diff();
  fill(diff.id, *message.mutable_layer());
  message.set_resolution_um(diff.resolution.micrometres());
  message.set_revision(diff.revision.number);
  for (const auto& packet : diff.packets) message.add_packets(packet.data(), packet.size());
  if (diff.next_key != kOrdinalEnd) message.set_next_key(diff.next_key);
  return framed(response.SerializeAsString());
}

std::string encode_layer_flushed(const FlushReport& report) {
  control::Response response;
  auto& flushed = *response.mutable_layer_flushed();
  fill(report.layer, *flushed.mutable_layer());
  flushed.set_revision(report.revision.number);
  flushed.set_blocks(report.blocks);
  return framed(response.SerializeAsString());
}

std::string encode_map_loaded(const LoadedLayer& layer) {
  control::Response response;
  fill(layer, *response.mutable_map_loaded());
  return framed(response.SerializeAsString());
}

std::string encode_loaded_layer(const LoadedLayer& layer) {
  control::Response response;
  fill(layer, *response.mutable_loaded_layer());
  return framed(response.SerializeAsString());
}

std::string encode_cells(const CellsAnswer& answer) {
  control::Response response;
  auto& message = *response.mutable_cells();
  message.set_cell_m(answer.cell_m());
  for (const CodeNode& node : answer.cells) {
    auto& cell = *message.add_cells();
    add_vector(answer.low_map(node), *cell.mutable_low_map_m());
    cell.set_state(name_of(node.code.state()));
    if (const auto cost = decode_cost(node.code.cost())) cell.set_cost(*cost);
    cell.set_stair(node.code.stair());
    cell.set_mixed(node.has_children);
  }
  return framed(response.SerializeAsString());
}

std::string encode_config(const std::string& yaml) {
  control::Response response;
  response.mutable_config()->set_yaml(yaml);
  return framed(response.SerializeAsString());
}

std::string encode_error(const std::string& text) {
  control::Response response;
  response.mutable_error()->set_text(text);
  return framed(response.SerializeAsString());
}

}  // namespace warren
