// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>

#include "daemon/fleet/conflict_watch.hpp"
#include "daemon/fleet/fleet_desk.hpp"
#include "daemon/fleet/fleet_map.hpp"
#include "daemon/fleet/fleet_report.hpp"
#include "daemon/fleet/node_book.hpp"
#include "daemon/fleet/own_word.hpp"
#include "daemon/fleet/restored_node.hpp"
#include "daemon/fleet/self_backlog.hpp"
#include "daemon/fleet/store_port.hpp"
#include "daemon/log_throttle.hpp"
#include "daemon/replication/replication.hpp"
#include "transport/udp/mesh_runner.hpp"

namespace warren {

struct FleetMeshConfig {
  std::optional<mesh::MeshRunner::Config> runner;  // none: this node meets nobody
  mesh::Key key{};
  replication::ReplicationConfig replication;
  std::uint64_t log_incarnation = 0;  // fresh random bits
  std::string name;
  NodeRole role = NodeRole::kRobot;
  Duration tick = std::chrono::seconds(1);
};

// Keeps the layers of this node and those of others in step over real sockets: drives replication
// and the mesh, writes what they and the mapping thread change to the store, and brings copies into
// the merge-map.
// Everything happens on the thread that runs the io_context.
class FleetMesh {
 public:
  // The map and the store must outlive this.
  FleetMesh(asio::io_context& io, const FleetMeshConfig& config, FleetMap& map, StorePort& store);
  FleetMesh(const FleetMesh&) = delete;
  FleetMesh& operator=(const FleetMesh&) = delete;

  // Before start(), and after the own layers were restored.
  void restore(StoredFleet stored);
  void start();
  // The map has just opened this layer, or restored it: what it holds is stored.
  void on_opened(const OwnLayer& layer);
  // The own layers may have news, and this of the self-map is to be stored with it.
  void on_ticked(std::vector<SelfLayerWrite> to_store);
  // Goes on until neighbours have what is stored here, but not longer than this; then stops, and
  // calls `done`.
  void drain(Duration at_most, std::function<void()> done);
  void stop();

  FleetReport report();
  // Who has what of every layer, as far as replication knows.
  std::vector<replication::LayerReport> replication_report() {
    return replication_.report(mesh::MeshRunner::now());
  }
  // The newest layer of the node of this name that is copied here; null if there is none.
  const Replica* newest_copy_of(const std::string& name) const;
  std::string name_of(MemberId member) const;
  bool knows_name_of(MemberId member) const { return nodes_.find(member) != nullptr; }
  FleetDesk& desk() { return desk_; }
  // Whether it meets others at all.
  bool is_on() const { return runner_.has_value(); }

 private:
  static constexpr Duration kBetweenCommits = std::chrono::milliseconds(50);
  static constexpr Duration kAfterRefusal = std::chrono::seconds(5);
  static constexpr Duration kCountersEvery = std::chrono::seconds(10);
  static constexpr MeshTime kAtOnce = MeshTime::min();
  static constexpr Duration kStoreLast = std::chrono::seconds(5);  // beyond drain()'s time
  struct Told {
    Revision revision;
    std::uint32_t pose = 0;
  };

  void on_event(const mesh::MeshEvent& event);
  void log_event(const mesh::MeshEvent& event) const;
  void turn_soon();
  void turn();
  void commit(MeshTime now);
  bool has_unstored() const {
    return !self_backlog_.empty() || replication_.has_unstored() ||
           store_is_behind_ != behind_said_ || (drained_ != nullptr && counters_at_ == kAtOnce);
  }
  void look_for_older_store();
  void add_moved(StoreBatch& rows);
  // Over this life and those before it on this store.
  std::map<std::string, std::uint64_t> counters();
  void on_committed(std::uint64_t batch, bool stored);
  void run_commands(MeshTime now);
  void run(MeshTime now, const replication::Command& command);
  void take_items();
  void adopt_copies();
  void take_poses(Replica& copy);
  void hear(MemberId from, std::span<const std::uint8_t> status);
  // True if it was a status, and news.
  bool read_status(const replication::LogId& log, replication::ItemNumber number,
                   const replication::Item& item);
  void speak(MeshTime now);
  std::optional<NodeStatus::Layer> stored_layer();
  void watch_conflicts();
  void watch_own_name();
  bool is_drained(MeshTime now) const;
  void wait();

  void fill_self(FleetReport& report);
  void fill_refused(FleetRefusedCounts& refused);
  void fill_interfaces(FleetReport& report);
  void fill_neighbours(FleetReport& report);
  void fill_layers(FleetReport& report) const;
  FleetLayerReport report_of(const replication::HeldLayer& held) const;
  void fill_wanted(const replication::HeldLayer& held, FleetLayerReport& report) const;
  FleetNodeReport& node_of(FleetReport& report, MemberId member) const;

  asio::io_context& io_;
  FleetMeshConfig config_;
  FleetMap& map_;
  StorePort& store_;
  replication::Replication replication_;
  std::optional<mesh::MeshRunner> runner_;
  SelfBacklog self_backlog_;
  std::map<std::uint32_t, std::uint32_t> poses_stored_;  // revisions of own layers, by number
  MeshTime committed_ = MeshTime::min();
  std::optional<NodeStatus::Layer> stored_layer_;  // as this node told of it last
  asio::steady_timer timer_;
  NodeBook nodes_;
  std::map<MemberId, MeshTime> status_came_;  // of these nodes, since the start
  OwnWord word_;
  FleetDesk desk_;
  ConflictWatch conflicts_;
  LogThrottle own_name_throttle_{1};
  std::uint64_t own_member_came_ = 0;                 // packets of another node of this name
  std::map<LayerId, ConflictLevel> conflict_levels_;  // as of the last round
  std::map<std::uint32_t, Told> told_;                // by number of own layers
  std::size_t adopted_ = 0;                           // layers of the book that were looked at
  MeshTime members_told_{};
  bool turn_posted_ = false;
  bool storing_ = false;
  bool store_is_behind_ = false;  // others hold more of our layers than it knows
  bool behind_said_ = false;      // to it
  bool stopped_ = false;
  MeshTime drain_until_ = kNever;
  std::function<void()> drained_;
  std::uint64_t batches_stored_ = 0;
  std::uint64_t batches_failed_ = 0;
  std::map<std::string, std::uint64_t> counters_before_;
  MeshTime counters_at_ = kAtOnce;  // then they go along with a batch
  std::uint64_t telemetry_refused_ = 0;
  std::uint64_t copies_refused_ = 0;
  std::uint64_t unknown_statuses_ = 0;
  std::uint64_t statuses_without_room_ = 0;
};

}  // namespace warren
