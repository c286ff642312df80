// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>

#include "daemon/fleet/fleet_map.hpp"
#include "daemon/fleet/fleet_mesh.hpp"
#include "daemon/fleet/no_store.hpp"
#include "daemon/fleet/node_store.hpp"
#include "daemon/mapper/mapper.hpp"

namespace warren {

struct FleetConfig {
  FleetMapConfig map;
  std::chrono::nanoseconds tick = std::chrono::seconds(1);
  FleetMeshConfig mesh;
  Duration shutdown = std::chrono::seconds(3);
};

// What the fleet thread has.
struct FleetParts {
  FleetMap& map;
  FleetMesh& mesh;
};

// A node's store, and what was in it.
struct FleetStart {
  std::optional<Store> store;  // none: all is forgotten at the end
  std::vector<StoredOwnLayer> own;
  StoredFleet fleet;
};

// The fleet thread: it alone touches the layers, and speaks to the mesh. At each tick the mapping
// thread hands over what changed; at most one hand-over is under way, a tick that comes too early
// is skipped and counted. The member functions belong to the thread of `io`, but for ask() and
// those for liveness, which any may call; questions are asked on the fleet thread and must not
// wait.
class Fleet {
 public:
  // Questions that may wait; one more is refused.
  static constexpr std::size_t kMaxQuestions = 1024;

  Fleet(asio::io_context& io, Mapper& mapper, const FleetConfig& config, FleetStart start);
  // Does what is in hand first.
  ~Fleet();
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;

  void start();
  // Publishes these last changes and all that is held back, gives neighbours time to take it, then
  // calls `done` on the fleet thread.
  void finish(std::vector<LayerChanges> last, std::function<void()> done);

  // `question` is called on the fleet thread. False: refused, too many wait.
  [[nodiscard]] bool ask(std::function<void(const FleetParts&)> question);
  std::uint64_t ticks_late() const { return ticks_late_; }

  bool has_store() const { return store_.has_value(); }
  // Nothing without a store. Any thread.
  std::optional<StoreStatus> store_status() const;

  // Liveness: ask for a beat, see later whether the count has moved. The store's thread counts too.
  void request_beat();
  std::uint64_t beats() const { return beats_.load(); }
  std::uint64_t store_beats() const;

 private:
  void wait_for_tick();
  void begin_tick();
  void tick(std::vector<LayerChanges> changes);

  Mapper& mapper_;
  asio::steady_timer timer_;
  FleetConfig config_;
  std::uint64_t ticks_late_ = 0;
  std::atomic<std::size_t> questions_{0};
  std::atomic<std::uint64_t> beats_{0};
  std::atomic<bool> tick_under_way_{false};
  std::atomic<bool> beat_requested_{false};
  bool finishing_ = false;

  asio::io_context fleet_io_{1};
  asio::executor_work_guard<asio::io_context::executor_type> running_;
  // Of the fleet thread.
  FleetMap map_;
  NoStore no_store_;
  std::optional<NodeStore> store_;
  FleetMesh mesh_;
  std::thread thread_;
};

}  // namespace warren
