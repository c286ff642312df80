// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <asio/thread_pool.hpp>

#include "daemon/fleet/fleet_map.hpp"
#include "daemon/mapper/mapper.hpp"

namespace warren {

// The fleet thread: it alone touches the layers. At each tick the mapping thread hands over what
// changed; at most one hand-over is under way, a tick that comes too early is skipped and counted.
// The member functions belong to the thread of the io_context, but for ask(), which any may call;
// questions are asked on the fleet thread and must not wait.
class Fleet {
 public:
  // Questions that may wait; one more is refused.
  static constexpr std::size_t kMaxQuestions = 1024;

  Fleet(asio::io_context& io, Mapper& mapper, const FleetMapConfig& config,
        std::chrono::nanoseconds tick);
  // Does what is in hand first.
  ~Fleet() { thread_.join(); }
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;

  void start() { wait_for_tick(); }
  // Publishes these last changes and all that is held back, then calls `done` on the fleet thread.
  void finish(std::vector<LayerChanges> last, std::function<void()> done);

  // `question` is called with the map on the fleet thread. False: refused, too many wait.
  [[nodiscard]] bool ask(std::function<void(FleetMap&)> question);
  std::uint64_t ticks_late() const { return ticks_late_; }

 private:
  void wait_for_tick();
  void begin_tick();

  Mapper& mapper_;
  asio::steady_timer timer_;
  std::chrono::nanoseconds tick_;
  bool finishing_ = false;
  std::uint64_t ticks_late_ = 0;
  std::atomic<bool> tick_under_way_{false};
  std::atomic<std::size_t> questions_{0};
  FleetMap map_;  // of the fleet thread
  asio::thread_pool thread_{1};
};

}  // namespace warren
