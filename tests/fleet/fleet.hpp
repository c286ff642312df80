// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/replication/replication.hpp"
#include "tests/fleet/disk.hpp"
#include "tests/fleet/history.hpp"
#include "tests/fleet/walker.hpp"
#include "tests/sim/simulation.hpp"
#include "tests/sim/upper.hpp"

namespace warren::fleet_sim {

// Faults planted at the border of the code under test, which the invariants must find.
enum class Planted : std::uint8_t {
  kNone,
  kClaimWidened,       // a packet claims keys that it does not cover
  kRevisionReused,     // a revision leaves before it is stored, and a crash takes it
  kLostIsBelieved,     // a lost packet counts as acknowledged
  kStoreWithoutCodes,  // holdings are stored, some of the blocks are not
  kMergedIntoSelf,     // what copies say gets into the own layer
};

struct FleetConfig {
  mesh::sim::Simulation::Config mesh;
  Walker::Config walker;
  Duration tick = std::chrono::seconds(1);
  std::vector<replication::SharePolicy> shares;  // by node; else everything
  std::vector<bool> writes;                      // by node; else all
  replication::Timers timers;
  Duration commit_max = std::chrono::milliseconds(50);
  bool check = true;  // after everything that arrives
  Planted planted = Planted::kNone;
};

// What of a node speaks and remembers: replication, endpoint, a model of its store; and a layer
// that it writes.
struct FleetNode {
  Disk disk;
  std::vector<std::unique_ptr<Replica>> own;  // the last is written
  std::unique_ptr<Walker> walker;
  std::unique_ptr<replication::Replication> replication;  // none: switched off
  std::unique_ptr<mesh::MapSource> source;                // what the endpoint sees of it
  MeshTime next_tick = kNever;
  std::optional<replication::StoreBatch> committing;
  std::optional<replication::StoreBatch> late;  // a planted fault: told as stored, and is not
  MeshTime committed_at = kNever;
  MeshTime members_told{};
  std::map<LayerId, std::uint64_t> checked;  // versions of copies
};

// N nodes in virtual time.
class Fleet final : public mesh::sim::Upper {
 public:
  explicit Fleet(const FleetConfig& config);

  mesh::sim::Simulation& mesh() { return simulation_; }
  FleetNode& node(std::size_t index) { return nodes_[index]; }
  std::size_t size() const { return nodes_.size(); }
  const History& history() const { return history_; }
  MeshTime now() const { return simulation_.now(); }

  void start(std::size_t index) { simulation_.start(index); }
  void start_all();
  void crash(std::size_t index) { simulation_.stop(index); }
  void lose_disk(std::size_t index);
  void stop_writing() { writing_ = false; }

  // Another's code in one voxel of a copy, as a memory or a member might alter it; false if there
  // is none to be altered.
  bool alter(std::size_t index, const LayerId& layer);
  // Everybody has the most of every layer that anyone has, of what it wants; who wants everything
  // has it with equal digests. Else what is lacking.
  std::optional<std::string> lacking() const;
  // Where the node is, in the fleet frame.
  Eigen::Vector3d position(std::size_t index) const;
  // A message to one or to all; nothing if the node is off, or its log full.
  std::optional<replication::ItemNumber> post(std::size_t index, std::optional<std::size_t> to,
                                              std::size_t bytes);
  // A message that has not come to whom it is for; those excused that a crash took unstored.
  std::optional<std::string> undelivered() const;
  // A node whose memory or store holds more than what was written explains.
  std::optional<std::string> beyond_bounds() const;
  // Of copies, in the present lives of all nodes.
  struct Packets {
    std::uint64_t applied = 0;
    std::uint64_t duplicate = 0;  // all of it was held already
  };
  Packets packets() const;
  // All that was sent but beacons; acknowledgements and questions are in it.
  std::uint64_t said_bytes();
  const std::vector<std::string>& failures() const { return failures_; }

  // Upper
  mesh::MapSource& on_start(MeshTime now, std::size_t node) override;
  void on_started(MeshTime now, std::size_t node, mesh::Endpoint& endpoint) override;
  void on_stop(std::size_t node) override;
  void on_event(MeshTime now, std::size_t node, mesh::MeshEvent&& event) override;
  void on_turn(MeshTime now, std::size_t node, mesh::Endpoint& endpoint) override;
  MeshTime next_turn(std::size_t node) const override;
  std::size_t memory_bytes(std::size_t node) const override;

 private:
  struct Posted {
    replication::LogId log;
    replication::ItemNumber number = 0;
    std::size_t from = 0;
    std::optional<std::size_t> to;
    bool excused = false;
  };
  void begin_layer(FleetNode& node, std::size_t index);
  void publish(MeshTime now, FleetNode& node);
  static void add_foreign(const FleetNode& node, std::vector<CodedBlock>& blocks);
  void check_own(const Replica& layer, Revision before, const std::vector<CodedBlock>& sensed);
  void commit(MeshTime now, FleetNode& node);
  void write(FleetNode& node);
  void run_commands(MeshTime now, FleetNode& node, mesh::Endpoint& endpoint);
  void check(FleetNode& node, std::size_t index);
  void take_items(FleetNode& node, std::size_t index);
  void excuse(std::size_t index, bool disk);
  void fail(std::string what);
  bool writes(std::size_t index) const;

  FleetConfig config_;
  world::Random random_;
  std::vector<FleetNode> nodes_;
  History history_;
  std::vector<std::string> failures_;
  bool writing_ = true;
  std::vector<Posted> posted_;
  std::map<std::pair<replication::LogId, replication::ItemNumber>, std::set<std::size_t>>
      items_taken_;
  mesh::sim::Simulation simulation_;
};

}  // namespace warren::fleet_sim
