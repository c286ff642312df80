// SPDX-License-Identifier: Apache-2.0
// What FleetMesh tells of itself.
#include <algorithm>
#include <chrono>

#include "daemon/fleet/fleet_mesh.hpp"

namespace warren {
namespace {

using mesh::MeshRunner;
using replication::HeldLayer;

constexpr double kMicro = 1e-6;

// What is known of a layer's newest revision, and of its content then.
struct Newest {
  Revision revision;
  std::optional<std::uint64_t> digest;

  void note(Revision at, std::optional<std::uint64_t> with) {
    if (at > revision) *this = {at, std::nullopt};
    if (at == revision && with) digest = with;
  }
};

Newest newest_of(const LayerId& layer, const NodeBook::Node* writer,
                 const std::map<MemberId, replication::Peer>& peers) {
  Newest newest;
  for (const auto& [id, peer] : peers) {
    const replication::Announcement* const said = peer.find(layer);
    if (said == nullptr) continue;
    const bool whole = said->holdings.intervals().size() == 1;
    newest.note(said->holdings.highest({}), whole ? said->digest : std::nullopt);
  }
  if (writer != nullptr && writer->status.layer && writer->status.layer->id == layer) {
    newest.note(writer->status.layer->revision, writer->status.layer->digest);
  }
  return newest;
}

// Over these keys alone; there are some.
Revision lowest_of(const Holdings& holdings, const replication::KeySet& keys) {
  Revision lowest = holdings.lowest(keys.intervals.front());
  for (const KeyInterval& interval : keys.intervals) {
    lowest = std::min(lowest, holdings.lowest(interval));
  }
  return lowest;
}

}  // namespace

std::optional<double> FleetLayerReport::lag_s() const {
  if (lag_revisions() == 0) return 0.0;
  if (!up_to_us || !latest_us) return std::nullopt;
  return static_cast<double>(*latest_us - *up_to_us) * kMicro;
}

FleetReport FleetMesh::report() {
  FleetReport report;
  fill_self(report);
  for (const auto& [member, node] : nodes_.nodes()) {
    FleetNodeReport& of = node_of(report, member);
    of.role = node.status.role;
    of.position_fleet = node.status.position_fleet;
    of.status_us = node.status.time_us;
    const auto came = status_came_.find(member);
    if (came == status_came_.end()) continue;
    of.status_came_s = std::chrono::duration<double>(MeshRunner::now() - came->second).count();
  }
  fill_neighbours(report);
  fill_layers(report);
  std::stable_sort(report.nodes.begin() + 1, report.nodes.end(),
                   [](const auto& a, const auto& b) { return a.name < b.name; });
  return report;
}

void FleetMesh::fill_self(FleetReport& report) {
  node_of(report, config_.replication.self).is_self = true;
  report.nodes.front().role = config_.role;
  if (runner_) fill_interfaces(report);
  fill_refused(report.refused);
  report.memory_bytes = replication_.memory_bytes();
  if (runner_) report.memory_bytes += runner_->endpoint().memory_bytes();
  report.batches_stored = batches_stored_;
  report.batches_failed = batches_failed_;
  report.storing = storing_;
  report.lifetime = counters();
}

void FleetMesh::fill_refused(FleetRefusedCounts& refused) {
  refused.replication = replication_.refused();
  const replication::LayerBook& layers = replication_.book();
  refused.layers = layers.layers_refused();
  refused.packets_without_room = layers.refused(replication::Refusal::kNoRoom);
  refused.packets_for_own_layers = layers.refused(replication::Refusal::kOwnLayer);
  for (const auto& held : layers.layers()) {
    const replication::WalkCounts walked = replication_.digests_of(held->slot);
    refused.digests.differences += walked.differences;
    refused.digests.regions += walked.regions;
    refused.digests.given_up += walked.given_up;
  }
  const replication::LogBook& logs = replication_.logs().book();
  refused.logs = logs.logs_refused();
  refused.log_messages = replication_.logs().refused();
  refused.own_items = logs.items_refused();
  for (const auto& held : logs.logs()) refused.items_dropped += held->log.dropped();
  refused.telemetry = telemetry_refused_;
  refused.copies = copies_refused_;
  refused.unknown_statuses = unknown_statuses_;
  refused.statuses_without_room = statuses_without_room_;
  refused.messages_unreadable = desk_.messages().unreadable();
  refused.messages_dropped = desk_.messages().dropped();
  refused.orders_refused = desk_.orders().refused();
  refused.orders_unauthorised = desk_.orders().unauthorised();
}

void FleetMesh::fill_interfaces(FleetReport& report) {
  report.mesh_on = true;
  const auto& names = config_.runner->sockets.interfaces;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto index = static_cast<InterfaceIndex>(i);
    const mesh::MeshSockets& sockets = runner_->sockets();
    report.interfaces.push_back(
        {names[i].name, sockets.is_open(index), sockets.problem(index), sockets.counts(index)});
  }
  report.endpoint = runner_->endpoint().counts();
}

void FleetMesh::fill_neighbours(FleetReport& report) {
  if (!runner_) return;
  const MeshTime now = MeshRunner::now();
  for (const mesh::Member& member : runner_->endpoint().members()) {
    FleetNodeReport& node = node_of(report, member.id);
    node.neighbour = member;
    node.last_heard_s = std::chrono::duration<double>(now - member.last_heard).count();
    const std::size_t index = member.path.interface;
    if (index < report.interfaces.size()) node.interface = report.interfaces[index].name;
    const auto peer = replication_.peers().find(member.id);
    if (peer == replication_.peers().end()) continue;
    node.sent = peer->second.traffic_out;
    node.received = peer->second.traffic_in;
  }
}

void FleetMesh::fill_layers(FleetReport& report) const {
  for (const auto& held : replication_.book().layers()) {
    node_of(report, MemberId{held->id.origin}).layers.push_back(report_of(*held));
  }
}

FleetLayerReport FleetMesh::report_of(const HeldLayer& held) const {
  const Replica& replica = held.replica();
  const NodeBook::Node* const writer = nodes_.find(MemberId{held.id.origin});
  FleetLayerReport report;
  report.id = held.id;
  report.own = held.own != nullptr;
  report.resolution = replica.resolution();
  report.held_everywhere = replica.holdings().lowest({});
  report.held_somewhere = replica.holdings().highest({});
  report.full = held.full;
  fill_wanted(held, report);
  report.behind = replication_.ahead_of_us().contains(held.id);
  const Newest newest = newest_of(held.id, writer, replication_.peers());
  report.latest = std::max(newest.revision, report.held_somewhere);
  if (newest.digest && report.latest == newest.revision &&
      report.held_everywhere == newest.revision) {
    report.digest_equal = replication::prefix_of(replica.digest().root()) == *newest.digest;
  }
  if (writer != nullptr && writer->status.layer && writer->status.layer->id == held.id) {
    report.up_to_us = writer->revisions.time_of(report.held_wanted);
    report.latest_us = writer->revisions.time_of(report.latest);
    const std::uint64_t known = writer->status.layer->known_voxels;
    if (!report.within_m) report.lag_voxels = known - std::min(known, replica.known_voxels());
  }
  if (const replication::Pull* const pull = replication_.pull_of(held.id)) {
    report.provider = pull->provider;
    report.hops = pull->hops;
  }
  report.conflict = conflicts_.score(held.id);
  if (const auto loaded = map_.loaded().find(held.id)) {
    report.retracted = loaded->retracted;
    report.retracted_by_fleet = loaded->retracted_by_fleet;
    report.out_of_reach = loaded->out_of_reach;
    report.unplaced = loaded->unplaced;
  }
  return report;
}

// Where nothing is wanted, before this node knows where it is, no less than all counts.
void FleetMesh::fill_wanted(const HeldLayer& held, FleetLayerReport& report) const {
  report.held_wanted = report.held_everywhere;
  const replication::SharePolicy& share = config_.replication.share;
  const replication::Pull* const pull = replication_.pull_of(held.id);
  if (share.share != replication::Share::kNear || pull == nullptr) return;
  if (pull->keys.intervals.empty()) return;
  report.held_wanted = lowest_of(held.replica().holdings(), pull->keys);
  report.within_m = share.radius_m;
}

FleetNodeReport& FleetMesh::node_of(FleetReport& report, MemberId member) const {
  const auto found = std::find_if(report.nodes.begin(), report.nodes.end(),
                                  [&](const auto& node) { return node.id == member; });
  if (found != report.nodes.end()) return *found;
  FleetNodeReport& node = report.nodes.emplace_back();
  node.id = member;
  if (member == config_.replication.self) {
    node.name = config_.name;
  } else if (const NodeBook::Node* const known = nodes_.find(member)) {
    node.name = known->status.name;
  }
  return node;
}

const Replica* FleetMesh::newest_copy_of(const std::string& name) const {
  for (const auto& held : replication_.book().layers()) {
    const MemberId writer{held->id.origin};
    if (!held->copy || name_of(writer) != name) continue;
    return desk_.newest_layer(writer).value_or(nullptr);
  }
  return nullptr;
}

}  // namespace warren
