// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "daemon/control/encoded_fields.hpp"
#include "daemon/control/response.hpp"
#include "proto/framing.hpp"
#include "transport/udp/address_text.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

void fill(const replication::MapTraffic& traffic, control::MapTraffic& message) {
  message.set_fresh_bytes(traffic.fresh_bytes);
  message.set_backlog_bytes(traffic.backlog_bytes);
  message.set_other_bytes(traffic.other_bytes);
}

double milliseconds(Duration time) { return static_cast<double>(time.count()) * 1e-3; }

void fill(const FleetNodeReport& node, const mesh::Member& member, control::FleetLink& link) {
  link.set_up(member.up);
  link.set_last_heard_s(node.last_heard_s);
  link.set_interface(node.interface);
  link.set_address(mesh::to_text(member.path.address));
  if (member.link.rtt) link.set_rtt_ms(milliseconds(*member.link.rtt));
  link.set_loss_out(member.link.loss_out);
  link.set_loss_in(member.link.loss_in);
  link.set_rate_kbit_s(member.link.rate_bit_s * 1e-3);
  link.set_queue_ms(milliseconds(member.link.queue));
  fill(node.sent, *link.mutable_sent());
  fill(node.received, *link.mutable_received());
}

std::string name_of(const FleetReport& report, MemberId member) {
  const auto found = std::find_if(report.nodes.begin(), report.nodes.end(),
                                  [&](const auto& node) { return node.id == member; });
  const bool named = found != report.nodes.end() && !found->name.empty();
  return named ? found->name : std::to_string(member.number);
}

void fill(const FleetReport& report, const FleetLayerReport& layer, control::FleetLayer& message) {
  fill(layer.id, *message.mutable_layer());
  message.set_own(layer.own);
  message.set_resolution_m(layer.resolution.metres());
  message.set_held_everywhere(layer.held_everywhere.number);
  message.set_held_somewhere(layer.held_somewhere.number);
  message.set_held_wanted(layer.held_wanted.number);
  if (layer.within_m) message.set_within_m(*layer.within_m);
  message.set_latest(layer.latest.number);
  message.set_lag_revisions(layer.lag_revisions());
  if (const auto lag_s = layer.lag_s()) message.set_lag_s(*lag_s);
  if (layer.lag_voxels) message.set_lag_voxels(*layer.lag_voxels);
  if (layer.up_to_us) message.set_up_to_us(*layer.up_to_us);
  if (layer.digest_equal) message.set_digest_equal(*layer.digest_equal);
  if (layer.provider) message.set_provider(name_of(report, *layer.provider));
  message.set_hops(layer.own ? 0U : layer.hops);
  message.set_retracted(layer.retracted);
  message.set_retracted_by_fleet(layer.retracted_by_fleet);
  message.set_out_of_reach(layer.out_of_reach);
  message.set_unplaced(layer.unplaced);
  message.set_full(layer.full);
  message.set_behind(layer.behind);
  if (layer.conflict) message.set_conflict(*layer.conflict);
}

void fill(const FleetReport& report, const FleetNodeReport& node, control::FleetNode& message) {
  message.set_origin(node.id.number);
  message.set_name(node.name);
  if (node.role) message.set_role(*node.role == NodeRole::kBase ? "base" : "robot");
  message.set_is_self(node.is_self);
  if (node.position_fleet) {
    for (const float coordinate : *node.position_fleet) message.add_position_fleet_m(coordinate);
  }
  if (node.status_us) message.set_status_us(*node.status_us);
  if (node.status_came_s) message.set_status_came_s(*node.status_came_s);
  if (node.neighbour) fill(node, *node.neighbour, *message.mutable_link());
  for (const FleetLayerReport& layer : node.layers) fill(report, layer, *message.add_layers());
}

void fill(const FleetInterfaceReport& interface, control::MeshInterface& message) {
  message.set_name(interface.name);
  message.set_open(interface.open);
  message.set_problem(interface.problem);
  const mesh::SocketCounts& counts = interface.counts;
  Counts& to = *message.mutable_counts();
  add_count("sent", counts.sent, to);
  add_count("received", counts.received, to);
  add_count("bytes_sent", counts.bytes_sent, to);
  add_count("bytes_received", counts.bytes_received, to);
  add_count("opened", counts.opened, to);
  add_count("open_failed", counts.open_failed, to);
  add_count("interface_down", counts.interface_down, to);
  add_count("too_large", counts.too_large, to);
  add_count("unreachable", counts.unreachable, to);
  add_count("buffers_full", counts.buffers_full, to);
  add_count("not_permitted", counts.not_permitted, to);
  add_count("send_failed", counts.send_failed, to);
  add_count("receive_failed", counts.receive_failed, to);
}

void fill(const mesh::EndpointCounts& counts, control::FleetStatus& status) {
  for (std::size_t i = 0; i < mesh::kUnusedNames.size(); ++i) {
    add_count(mesh::kUnusedNames[i], counts.unused[i], *status.mutable_unused());
  }
  for (std::size_t i = 0; i < mesh::kSentClassNames.size(); ++i) {
    auto* const sent = status.add_sent();
    sent->set_name(mesh::kSentClassNames[i]);
    sent->set_packets(counts.sent[i].packets);
    sent->set_bytes(counts.sent[i].bytes);
  }
  status.set_packets_in(counts.packets_in);
  status.set_ip_bytes_in(counts.ip_bytes_in);
  status.set_packets_out(counts.packets_out);
  status.set_ip_bytes_out(counts.ip_bytes_out);
}

void fill_refused(const replication::RefusedCounts& by_replication, Counts& refused) {
  add_count("malformed_announcements", by_replication.malformed_announcements, refused);
  add_count("changed_slots", by_replication.changed_slots, refused);
  add_count("malformed_messages", by_replication.malformed_messages, refused);
  add_count("unknown_slots", by_replication.unknown_slots, refused);
  add_count("other_resolution", by_replication.other_resolution, refused);
  add_count("stale_wishes", by_replication.stale_wishes, refused);
  add_count("gaps", by_replication.gaps, refused);
  add_count("wishes_for_lost", by_replication.wishes_for_lost, refused);
  add_count("peers_refused", by_replication.peers_refused, refused);
}

void fill_refused(const FleetRefusedCounts& counts, Counts& refused) {
  fill_refused(counts.replication, refused);
  add_count("layers_refused", counts.layers, refused);
  add_count("packets_without_room", counts.packets_without_room, refused);
  add_count("packets_for_own_layers", counts.packets_for_own_layers, refused);
  add_count("logs_refused", counts.logs, refused);
  add_count("log_messages_refused", counts.log_messages, refused);
  add_count("own_items_refused", counts.own_items, refused);
  add_count("items_dropped", counts.items_dropped, refused);
  add_count("digests_differed", counts.digests.differences, refused);
  add_count("regions_repaired", counts.digests.regions, refused);
  add_count("repairs_given_up", counts.digests.given_up, refused);
  add_count("telemetry_refused", counts.telemetry, refused);
  add_count("copies_not_merged", counts.copies, refused);
  add_count("unknown_statuses", counts.unknown_statuses, refused);
  add_count("statuses_without_room", counts.statuses_without_room, refused);
  add_count("messages_unreadable", counts.messages_unreadable, refused);
  add_count("messages_dropped", counts.messages_dropped, refused);
  add_count("orders_refused", counts.orders_refused, refused);
  add_count("orders_unauthorised", counts.orders_unauthorised, refused);
}

}  // namespace

std::string encode_fleet_status(const FleetReport& report) {
  control::Response response;
  auto& status = *response.mutable_fleet_status();
  status.set_mesh_on(report.mesh_on);
  for (const FleetNodeReport& node : report.nodes) fill(report, node, *status.add_nodes());
  for (const auto& interface : report.interfaces) fill(interface, *status.add_interfaces());
  fill(report.endpoint, status);
  fill_refused(report.refused, *status.mutable_refused());
  status.set_memory_bytes(report.memory_bytes);
  status.set_batches_stored(report.batches_stored);
  status.set_batches_failed(report.batches_failed);
  for (const auto& [name, count] : report.lifetime) {
    add_count(name.c_str(), count, *status.mutable_lifetime());
  }
  return framed(response.SerializeAsString());
}

}  // namespace warren
