// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/fleet.hpp"

#include <algorithm>
#include <utility>

#include "tests/fleet/planted.hpp"
#include "transport/visitor.hpp"

namespace warren::fleet_sim {
namespace {

constexpr Duration kMembersEvery = std::chrono::seconds(1);
constexpr std::size_t kFailuresMax = 10;

mesh::sim::Simulation::Config with_upper(mesh::sim::Simulation::Config config,
                                         mesh::sim::Upper& upper) {
  config.upper = &upper;
  return config;
}

Duration at_most(world::Random& random, Duration most) {
  return Duration(
      static_cast<std::int64_t>(random.uniform(0.0, static_cast<double>(most.count()))));
}

}  // namespace

Fleet::Fleet(const FleetConfig& config)
    : config_(config),
      random_(config.mesh.seed * 77 + 5),
      nodes_(config.mesh.nodes),
      simulation_(with_upper(config.mesh, *this)) {}

void Fleet::start_all() {
  for (std::size_t i = 0; i < nodes_.size(); ++i) start(i);
}

bool Fleet::writes(std::size_t index) const {
  return index >= config_.writes.size() || config_.writes[index];
}

void Fleet::begin_layer(FleetNode& node, std::size_t index) {
  const LayerId id{static_cast<std::uint32_t>(index + 1),
                   static_cast<std::uint32_t>(node.own.size()), random_.next()};
  node.own.push_back(std::make_unique<Replica>(id, kDefaultResolution));
  node.walker = std::make_unique<Walker>(config_.walker, random_.next());
}

Eigen::Vector3d Fleet::position(std::size_t index) const {
  if (!nodes_[index].walker) return Eigen::Vector3d::Zero();
  const BlockKey at = nodes_[index].walker->at();
  return Eigen::Vector3d(at.x, at.y, at.z) * kBlockEdge * kDefaultResolution.metres();
}

mesh::MapSource& Fleet::on_start(MeshTime now, std::size_t index) {
  FleetNode& node = nodes_[index];
  replication::ReplicationConfig config;
  config.self = {static_cast<std::uint32_t>(index + 1)};
  config.timers = config_.timers;
  config.group_broadcast.assign(1, config_.mesh.interface.group_broadcast);
  if (index < config_.shares.size()) config.share = config_.shares[index];
  node.replication = std::make_unique<replication::Replication>(config);
  node.source = std::make_unique<PlantedSource>(*node.replication, config_.planted);
  node.own.clear();
  for (const auto& [id, stored] : node.disk.layers()) {
    if (stored.own) {
      node.own.push_back(node.disk.read(id));
    } else if (!node.replication->restore_copy(node.disk.read(id))) {
      fail("a stored copy was not taken back");
    }
  }
  if (writes(index) && node.own.empty()) begin_layer(node, index);
  for (const auto& layer : node.own) node.replication->add_own(*layer);
  if (!node.replication->restore_logs(now, node.disk.logs())) fail("stored logs were not taken");
  node.replication->open_log(random_.next());
  node.replication->on_position(now, position(index));
  node.next_tick = writes(index) ? now + at_most(random_, config_.tick) : kNever;
  node.committing.reset();
  node.late.reset();
  node.committed_at = kNever;
  node.checked.clear();
  for (const auto& layer : node.replication->book().layers()) {
    if (const auto fault = history_.fault_of(layer->replica())) {
      fail("after a start: " + *fault + ", layer of " + std::to_string(layer->id.origin) +
           " at node " + std::to_string(index + 1));
    }
  }
  return *node.source;
}

void Fleet::on_started(MeshTime, std::size_t, mesh::Endpoint&) {}

void Fleet::lose_disk(std::size_t index) {
  excuse(index, true);
  nodes_[index].disk.lose();
}

void Fleet::on_stop(std::size_t index) {
  excuse(index, false);
  nodes_[index].source.reset();
  nodes_[index].replication.reset();
}

void Fleet::publish(MeshTime now, FleetNode& node) {
  node.next_tick = now + config_.tick;
  if (!writing_) return;
  Replica& layer = *node.own.back();
  const auto sensed = node.walker->step(layer);
  node.replication->on_position(now, position(layer.id().origin - 1));
  auto blocks = sensed;
  if (config_.planted == Planted::kMergedIntoSelf) add_foreign(node, blocks);
  const Revision before = layer.holdings().at(0);
  if (layer.publish(blocks) == before) return;
  check_own(layer, before, sensed);
  std::vector<BlockOrdinal> written;
  for (const CodedBlock& block : blocks) written.push_back(block.block);
  history_.record(layer, written);
  node.replication->on_published(now, layer.id());
}

// A block of each copy into the own layer.
void Fleet::add_foreign(const FleetNode& node, std::vector<CodedBlock>& blocks) {
  for (const auto& held : std::as_const(*node.replication).book().layers()) {
    if (!held->copy) continue;
    held->copy->for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
      const bool taken = std::any_of(blocks.begin(), blocks.end(),
                                     [&](const auto& other) { return other.block == block; });
      if (!taken) blocks.push_back({block, found.codes});
      return taken;
    });
  }
}

// What a node writes into its own layer is what it sensed.
void Fleet::check_own(const Replica& layer, Revision before,
                      const std::vector<CodedBlock>& sensed) {
  layer.for_each_changed({}, before, [&](BlockOrdinal block, const LayerBlock& now) {
    const auto found = std::find_if(sensed.begin(), sensed.end(),
                                    [&](const auto& other) { return other.block == block; });
    if (found == sensed.end() || found->codes.unpack() != now.codes.unpack()) {
      fail("the own layer of " + std::to_string(layer.id().origin) + " has what it never sensed");
    }
    return true;
  });
}

void Fleet::commit(MeshTime now, FleetNode& node) {
  if (node.committing && now >= node.committed_at) {
    write(node);
    node.replication->on_stored(now, node.committing->number);
    node.committing.reset();
    node.committed_at = kNever;
  }
  if (node.committing || !node.replication->has_unstored()) return;
  node.committing = node.replication->take_batch();
  node.committed_at = now + at_most(random_, config_.commit_max);
  if (config_.planted == Planted::kStoreWithoutCodes) {
    for (auto& layer : node.committing->layers) {
      if (!layer.own && layer.blocks.size() > 1) layer.blocks.pop_back();
    }
  }
}

void Fleet::write(FleetNode& node) {
  if (config_.planted != Planted::kRevisionReused) return node.disk.write(*node.committing);
  if (node.late) node.disk.write(*node.late);
  node.late = node.committing;
}

void Fleet::run_commands(MeshTime now, FleetNode& node, mesh::Endpoint& endpoint) {
  while (auto command = node.replication->poll_command()) {
    std::visit(mesh::Visitor{
                   [&](const replication::SetTelemetry& set) {
                     if (!endpoint.set_telemetry(now, set.key, set.bytes)) {
                       fail("telemetry was refused");
                     }
                   },
                   [&](const replication::Wake& wake) { endpoint.wake(now, wake.member); },
                   [&](const replication::WakeGroup& wake) { endpoint.wake_group(wake.interface); },
                   [&](const replication::SendParcel& parcel) {
                     const auto key =
                         endpoint.send_parcel(now, parcel.to, parcel.priority, parcel.bytes);
                     node.replication->on_parcel_sent(
                         parcel.number, key ? std::optional<mesh::ParcelKey>(*key) : std::nullopt);
                   },
                   [&](const replication::FinishParcel& finish) {
                     endpoint.finish_parcel(now, finish.from, finish.key);
                   }},
               *command);
  }
}

void Fleet::on_turn(MeshTime now, std::size_t index, mesh::Endpoint& endpoint) {
  FleetNode& node = nodes_[index];
  if (now >= node.next_tick) publish(now, node);
  commit(now, node);
  if (now >= node.members_told + kMembersEvery) {
    node.members_told = now;
    node.replication->on_members(endpoint.members());
  }
  node.replication->advance(now);
  run_commands(now, node, endpoint);
  take_items(node, index);
}

MeshTime Fleet::next_turn(std::size_t index) const {
  const FleetNode& node = nodes_[index];
  return std::min({node.next_tick, node.committed_at, node.replication->next_deadline()});
}

void Fleet::on_event(MeshTime now, std::size_t index, mesh::MeshEvent&& event) {
  FleetNode& node = nodes_[index];
  node.replication->on_event(now, event);
  if (config_.check && std::holds_alternative<mesh::MapArrived>(event)) check(node, index);
}

void Fleet::check(FleetNode& node, std::size_t index) {
  for (const auto& layer : node.replication->book().layers()) {
    if (layer->own != nullptr) continue;
    auto& checked = node.checked[layer->id];
    if (checked == layer->version) continue;
    checked = layer->version;
    if (const auto fault = history_.fault_of(*layer->copy)) {
      fail(*fault + ", layer of " + std::to_string(layer->id.origin) + " at node " +
           std::to_string(index + 1));
    }
  }
}

bool Fleet::alter(std::size_t index, const LayerId& id) {
  replication::LayerBook& book = nodes_[index].replication->book();
  replication::HeldLayer* const layer = book.find(id);
  if (layer == nullptr || !layer->copy) return false;
  std::vector<StoredBlock> blocks;
  layer->copy->for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    blocks.push_back({block, found.history.latest(), found.codes});
    return true;
  });
  if (blocks.empty()) return false;
  BlockCodes codes = blocks.back().codes.unpack();
  codes.set(0,
            codes.at(0) == VoxelCode::free() ? VoxelCode::occupied(1, false) : VoxelCode::free());
  blocks.back().codes = CodeBlock(codes);
  const KeyInterval keys{blocks.back().block, blocks.back().block + 1};
  const Replica altered(id, layer->copy->resolution(), layer->copy->holdings(), blocks);
  if (!book.forget(now(), *layer, keys)) return false;
  const auto packet = altered.encode({keys, Revision{}});
  return packet && book.apply(now(), *layer, packet->bytes).result == ApplyResult::kApplied;
}

std::uint64_t Fleet::said_bytes() {
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const mesh::EndpointCounts counts = simulation_.node(i).endpoint->counts();
    for (std::size_t of = 0; of < mesh::kSentClassNames.size(); ++of) {
      const auto sent = static_cast<mesh::SentClass>(of);
      if (sent != mesh::SentClass::kBeacon) bytes += counts[sent].bytes;
    }
  }
  return bytes;
}

std::size_t Fleet::memory_bytes(std::size_t index) const {
  return nodes_[index].replication ? nodes_[index].replication->memory_bytes() : 0;
}

void Fleet::fail(std::string what) {
  if (failures_.size() < kFailuresMax) {
    failures_.push_back(std::to_string(now().time_since_epoch().count() / 1000) +
                        " ms: " + std::move(what));
  }
}

}  // namespace warren::fleet_sim
