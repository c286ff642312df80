// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "daemon/replication/announcing.hpp"
#include "daemon/replication/digest_walk.hpp"
#include "daemon/replication/log_exchange.hpp"
#include "daemon/replication/node_state.hpp"
#include "daemon/replication/pulling.hpp"
#include "daemon/replication/report.hpp"
#include "daemon/replication/serving.hpp"

namespace warren::replication {

// What has to be stored in one transaction, and then told to on_stored().
struct StoreBatch {
  std::uint64_t number = 0;
  std::vector<StoredLayer> layers;
  std::vector<StoredLog> logs;
};

// What somebody else holds of an own layer.
struct HeldAhead {
  MemberId holder;
  Revision held;
  Revision known;  // here, then
};

// Keeps the layers of a fleet in step, over an endpoint. A pure state machine: it reads no clock,
// opens no socket, draws no random number. Its driver, after anything that it tells: advance(),
// then does the commands. One thread.
class Replication final : public mesh::MapSource {
 public:
  explicit Replication(const ReplicationConfig& config);

  // Layers. The own ones must outlive this, and what they hold when they are added is stored.
  bool add_own(const Replica& layer) { return node_.book.add_own(layer); }
  bool restore_copy(std::unique_ptr<Replica> copy) { return node_.book.restore(std::move(copy)); }
  // Logs, as the store has them; then the one to write, if none of them is.
  bool restore_logs(MeshTime now, std::span<const StoredLog> logs);
  bool open_log(std::uint64_t incarnation) {
    return logs_.book().open({node_.config.self.number, incarnation});
  }
  // Nothing: no log is open, it is full, or the item is too long. It leaves when it is stored.
  std::optional<ItemNumber> append(MeshTime now, Item item);
  // Items of others, when they are stored; again after a restart those addressed to us without a
  // receipt. Poses of copies have been taken over.
  std::optional<ArrivedItem> poll_item();

  // The own layer has a new revision. It leaves this node only when it is stored.
  void on_published(MeshTime now, const LayerId& layer);
  void on_position(MeshTime now, const Eigen::Vector3d& position_fleet);

  // What the endpoint says: every event of it, and now and then how its links are.
  void on_event(MeshTime now, const mesh::MeshEvent& event);
  void on_members(std::span<const mesh::Member> members);

  // Does what is due; then there may be commands.
  void advance(MeshTime now);
  // When advance() has something to do without anything else happening.
  MeshTime next_deadline() const;
  std::optional<Command> poll_command();
  // What became of SendParcel: nothing if the endpoint refused it.
  void on_parcel_sent(std::uint64_t number, std::optional<mesh::ParcelKey> key) {
    logs_.on_parcel_sent(number, key);
  }

  // What changed since the last batch; nothing of it is announced, and no own revision leaves,
  // before it is stored.
  bool has_unstored() const { return node_.book.has_unstored() || logs_.book().has_unstored(); }
  StoreBatch take_batch();
  void on_stored(MeshTime now, std::uint64_t batch);
  // The store would not have it: the next batch says it again.
  void on_refused(std::uint64_t batch);

  const LayerBook& book() const { return node_.book; }
  LayerBook& book() { return node_.book; }
  const LogExchange& logs() const { return logs_; }
  LogBook& log_book() { return logs_.book(); }
  const Pull* pull_of(const LayerId& layer) const;
  WalkCounts digests_of(Slot slot) const { return walk_.counts_of(slot); }
  const std::map<MemberId, Peer>& peers() const { return node_.peers; }
  const RefusedCounts& refused() const { return node_.refused; }
  // Own layers of which a member holds more than we knew to have written: our store is older than
  // what has left us, and revisions may be written twice. Whoever drives this must see to it that
  // another layer is begun.
  const std::map<LayerId, HeldAhead>& ahead_of_us() const { return ahead_of_us_; }
  std::uint64_t announcements() const { return announcing_.sent(); }
  std::uint64_t announced_bytes() const { return announcing_.sent_bytes(); }
  // Who has what of every layer; bytes by class stand in peers().
  std::vector<LayerReport> report(MeshTime now) {
    node_.now = now;
    return replication::report(node_, pulling_, walk_);
  }
  std::uint64_t group_bytes() const { return serving_.group_bytes(); }
  std::size_t memory_bytes() const;

  // MapSource. In a packet of this size every block fits.
  std::size_t bytes_min() const override { return kDiffOverhead + kPacketBytesMin; }
  std::optional<Packet> next_for(MemberId to, mesh::MapClass wanted, std::size_t limit) override;
  std::optional<Packet> next_for_group(InterfaceIndex interface, std::size_t limit) override;
  void on_acknowledged(MemberId from, std::uint64_t ticket) override;
  void on_lost(MemberId from, std::uint64_t ticket) override;

 private:
  void on_map(Peer& from, const mesh::MapArrived& map);
  void on_telemetry(Peer& from, const mesh::TelemetryArrived& telemetry);
  void on_restarted(Peer& peer);
  void on_forgotten(MemberId member);
  void take_pose(const Item& item);
  void take_poses();
  void look_behind(const HeldLayer& own, const Peer& from);
  void set_up(MemberId member, bool up);
  std::optional<Packet> next_wishes(Peer& to, std::size_t limit);

  NodeState node_;
  Serving serving_;
  Pulling pulling_;
  DigestWalk walk_;
  Announcing announcing_;
  LogExchange logs_;
  std::uint64_t batches_ = 0;
  std::size_t layers_placed_ = 0;  // so many have the poses that the logs hold
  std::map<LayerId, HeldAhead> ahead_of_us_;
};

}  // namespace warren::replication
