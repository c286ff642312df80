// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet_mesh.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <asio/post.hpp>

#include "daemon/fleet/wall_clock.hpp"
#include "daemon/log.hpp"
#include "transport/visitor.hpp"

namespace warren {
namespace {

using mesh::MeshRunner;
using replication::HeldLayer;

constexpr std::uint16_t kStatusKey = 1;  // of telemetry; replication's begin at kLayerKeys
constexpr Duration kMembersEvery = std::chrono::seconds(1);
constexpr Duration kLookWhileDraining = std::chrono::milliseconds(50);

replication::Item item_of(const NodeStatus& status) {
  constexpr std::string_view kName = "status";
  replication::Item item;
  item.kind = replication::ItemKind::kStatus;
  item.name.assign(kName.begin(), kName.end());
  item.bytes = encode(status);
  return item;
}

}  // namespace

FleetMesh::FleetMesh(asio::io_context& io, const FleetMeshConfig& config, FleetMap& map,
                     StorePort& store)
    : io_(io),
      config_(config),
      map_(map),
      store_(store),
      replication_(config.replication),
      timer_(io),
      word_(config.tick),
      desk_({config.replication.self, config.role, config.log_incarnation, replication_, map,
             nodes_, [this] { turn_soon(); }}) {
  if (!config.runner) return;
  runner_.emplace(io, *config.runner, std::make_shared<mesh::PresharedKeys>(config.key),
                  replication_, [this](const mesh::MeshEvent& event) { on_event(event); });
}

void FleetMesh::start() {
  if (replication_.log_book().own() == nullptr) {
    (void)replication_.open_log(config_.log_incarnation);
  }
  desk_.start();
  adopt_copies();
  if (runner_) runner_->start();
  turn_soon();
}

void FleetMesh::stop() {
  stopped_ = true;
  desk_.stop();
  timer_.cancel();
  if (runner_) runner_->stop();
}

void FleetMesh::on_opened(const OwnLayer& layer) {
  if (!replication_.add_own(layer.layer())) {
    log_error("fleet: too many layers: this node's newest is not shared");
  }
}

void FleetMesh::on_ticked(std::vector<SelfLayerWrite> to_store) {
  const MeshTime now = MeshRunner::now();
  for (SelfLayerWrite& write : to_store) self_backlog_.add(std::move(write));
  for (const auto& [number, own] : map_.own_layers()) {
    Told& told = told_[number];
    const Replica& layer = own.layer();
    const Revision revision = layer.holdings().at(0);
    if (std::exchange(told.revision, revision) != revision) {
      replication_.on_published(now, layer.id());
    }
    const WrittenPose& pose = layer.pose().origin();
    if (pose.revision == told.pose) continue;
    const bool said =
        replication_.append(now, replication::item_of({layer.id(), false, pose})).has_value();
    if (said) told.pose = pose.revision;
  }
  if (const auto position = map_.position_fleet()) replication_.on_position(now, *position);
  desk_.on_ticked(now, wall_clock_us(), drained_ != nullptr);
  watch_conflicts();
  // Else the word goes out with the revision, when that is stored.
  if (storing_ || !has_unstored()) speak(now);
  turn_soon();
}

// The newest own layer as of the last revision that is stored: what a crash may make this node
// write again must not be heard of.
std::optional<NodeStatus::Layer> FleetMesh::stored_layer() {
  if (map_.own_layers().empty()) return std::nullopt;
  const Replica& layer = map_.own_layers().rbegin()->second.layer();
  const HeldLayer* const held = replication_.book().find(layer.id());
  if (held != nullptr && held->may_be_told()) {
    stored_layer_ = {layer.id(), layer.holdings().at(0),
                     replication::prefix_of(layer.digest().root()), layer.known_voxels()};
  }
  return stored_layer_;
}

void FleetMesh::speak(MeshTime now) {
  NodeStatus status{config_.name, config_.role, wall_clock_us(), std::nullopt, std::nullopt};
  status.layer = stored_layer();
  if (const auto position = map_.position_fleet()) status.position_fleet = position->cast<float>();
  const OwnWord::Tell tell = word_.judge(now, status, drained_ != nullptr);
  nodes_.hear(config_.replication.self, status);
  if (tell.neighbours) run(now, replication::SetTelemetry{kStatusKey, encode(status)});
  if (tell.fleet) (void)replication_.append(now, item_of(status));
}

void FleetMesh::on_event(const mesh::MeshEvent& event) {
  std::visit(
      mesh::Visitor{[&](const mesh::TelemetryArrived& telemetry) {
                      if (telemetry.key == kStatusKey) hear(telemetry.from, telemetry.bytes);
                    },
                    [&](const mesh::MemberDown& down) { nodes_.on_silent(down.member); },
                    [&](const mesh::MemberForgotten& gone) { nodes_.on_silent(gone.member); },
                    [](const auto&) {}},
      event);
  log_event(event);
  replication_.on_event(MeshRunner::now(), event);
  turn_soon();
}

void FleetMesh::log_event(const mesh::MeshEvent& event) const {
  std::visit(mesh::Visitor{[&](const mesh::MemberUp& up) {
                             log_info("fleet: " + name_of(up.member) + " is here");
                           },
                           [&](const mesh::MemberDown& down) {
                             log_info("fleet: " + name_of(down.member) + " is silent");
                           },
                           [&](const mesh::MemberRestarted& restarted) {
                             log_info("fleet: " + name_of(restarted.member) + " has restarted");
                           },
                           [](const auto&) {}},
             event);
}

std::string FleetMesh::name_of(MemberId member) const {
  const NodeBook::Node* const node = nodes_.find(member);
  return node != nullptr ? node->status.name : "node " + std::to_string(member.number);
}

void FleetMesh::hear(MemberId from, std::span<const std::uint8_t> bytes) {
  const auto status = read_node_status(bytes);
  if (!status) return (void)++unknown_statuses_;
  if (nodes_.hear(from, *status)) status_came_[from] = MeshRunner::now();
  if (nodes_.find(from) == nullptr) ++statuses_without_room_;
}

bool FleetMesh::read_status(const replication::LogId& log, replication::ItemNumber number,
                            const replication::Item& item) {
  if (item.kind != replication::ItemKind::kStatus) return false;
  const auto status = read_node_status(item.bytes);
  if (!status) {
    ++unknown_statuses_;
    return false;
  }
  const MemberId from{log.origin};
  const bool is_news = nodes_.read(from, {log.incarnation, number}, *status);
  if (nodes_.find(from) == nullptr) ++statuses_without_room_;
  return is_news;
}

void FleetMesh::turn_soon() {
  if (stopped_ || std::exchange(turn_posted_, true)) return;
  asio::post(io_, [this] {
    turn_posted_ = false;
    turn();
  });
}

void FleetMesh::turn() {
  if (stopped_) return;
  const MeshTime now = MeshRunner::now();
  if (now >= members_told_ + kMembersEvery) {
    members_told_ = now;
    if (runner_) replication_.on_members(runner_->endpoint().members());
    watch_own_name();
  }
  look_for_older_store();
  commit(now);
  replication_.advance(now);
  run_commands(now);
  adopt_copies();
  take_items();
  desk_.settle(now);
  if (runner_) runner_->run();
  if (drained_ && is_drained(now)) {
    stop();
    return std::exchange(drained_, nullptr)();
  }
  wait();
}

void FleetMesh::run_commands(MeshTime now) {
  while (const auto command = replication_.poll_command()) run(now, *command);
}

void FleetMesh::run(MeshTime now, const replication::Command& command) {
  if (!runner_) return;
  mesh::Endpoint& endpoint = runner_->endpoint();
  std::visit(mesh::Visitor{
                 [&](const replication::SetTelemetry& set) {
                   if (!endpoint.set_telemetry(now, set.key, set.bytes)) ++telemetry_refused_;
                 },
                 [&](const replication::Wake& wake) { endpoint.wake(now, wake.member); },
                 [&](const replication::WakeGroup& wake) { endpoint.wake_group(wake.interface); },
                 [&](const replication::SendParcel& parcel) {
                   const auto key =
                       endpoint.send_parcel(now, parcel.to, parcel.priority, parcel.bytes);
                   replication_.on_parcel_sent(
                       parcel.number, key ? std::optional<mesh::ParcelKey>(*key) : std::nullopt);
                 },
                 [&](const replication::FinishParcel& finish) {
                   endpoint.finish_parcel(now, finish.from, finish.key);
                 }},
             command);
}

void FleetMesh::take_items() {
  bool poses = false;
  while (const auto arrived = replication_.poll_item()) {
    poses = poses || arrived->item.kind == replication::ItemKind::kLayerPose;
    if (read_status(arrived->log, arrived->number, arrived->item)) {
      status_came_[MemberId{arrived->log.origin}] = MeshRunner::now();
    }
    desk_.on_item(*arrived);
  }
  if (poses) map_.place_others();
}

void FleetMesh::adopt_copies() {
  const auto& layers = replication_.book().layers();
  for (; adopted_ < layers.size(); ++adopted_) {
    if (!layers[adopted_]->copy) continue;
    Replica& copy = *layers[adopted_]->copy;
    take_poses(copy);
    const auto added = map_.loaded().add_copy(copy);
    if (added) continue;
    ++copies_refused_;
    log_warning("fleet: a layer of " + name_of({copy.id().origin}) +
                " is kept, but not merged: " + added.error());
  }
}

void FleetMesh::wait() {
  const MeshTime now = MeshRunner::now();
  MeshTime until = std::min(replication_.next_deadline(), members_told_ + kMembersEvery);
  if (!storing_ && has_unstored()) until = std::min(until, committed_ + kBetweenCommits);
  if (drained_) until = std::min(until, now + kLookWhileDraining);
  timer_.expires_at(std::max(until, now + Duration(1000)));
  timer_.async_wait([this](std::error_code cancelled) {
    if (!cancelled) turn();
  });
}

}  // namespace warren
