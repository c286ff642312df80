// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "daemon/store/store.hpp"

namespace warren {

struct StoreWorkerConfig {
  std::size_t queue_batches_max = 64;
  std::size_t queue_bytes_max = std::size_t{64} << 20;       // of batches; one alone may be larger
  std::size_t transaction_bytes_max = std::size_t{8} << 20;  // likewise
  std::chrono::milliseconds retry_after{1000};               // a transaction that failed
};

// Whether the disk takes what it is given. While it does not, nothing is lost but time: the map
// grows in memory, and revisions do not leave the node.
struct StoreHealth {
  std::optional<StoreFailure> failing;  // why; nothing: all is well
  std::uint64_t failed_in_a_row = 0;
};

struct StoreStatus {
  StoreHealth health;
  std::size_t batches_queued = 0;
  std::size_t bytes_queued = 0;
  std::uint64_t transactions = 0;
  std::uint64_t transactions_failed = 0;
  std::uint64_t batches_refused = 0;  // by submit()
  std::array<std::uint64_t, kBatchResults> results{};
  std::uint64_t layers_evicted = 0;
  std::uint64_t items_evicted = 0;
  std::uint64_t writes_dropped = 0;  // to layers that were evicted
  StoreUsage usage;
};

// The thread that writes. What waits when it turns to the queue goes into one transaction, so the
// disk is waited for once, not once per batch. Order is kept. Any thread may call the members.
class StoreWorker {
 public:
  using Done = std::function<void(BatchResult)>;
  struct Dependencies {
    // Runs a call on the caller's thread, soon; must not wait. Every callback comes this way.
    std::function<void(std::function<void()>)> post;
    // When the disk begins to refuse, and when it takes again.
    std::function<void(const StoreHealth&)> on_health = [](const StoreHealth&) {};
    // What went to make room.
    std::function<void(const Evictions&)> on_evicted = [](const Evictions&) {};
  };

  StoreWorker(Store store, const StoreWorkerConfig& config, Dependencies dependencies);
  // Writes what is queued; if the disk refuses even now, the rest is given up.
  ~StoreWorker();
  StoreWorker(const StoreWorker&) = delete;
  StoreWorker& operator=(const StoreWorker&) = delete;

  // Calls `done` once, with what became of the batch. False, and nothing is called: the queue is
  // full, as it is while the disk refuses. The caller keeps what it wanted written and puts it into
  // a later batch: nothing here is worth more than the latest state.
  [[nodiscard]] bool submit(StoreBatch batch, Done done);

  StoreStatus status() const;

  // Liveness: ask for a beat, see later whether the count has moved.
  void request_beat();
  std::uint64_t beats() const { return beats_.load(); }

 private:
  struct Queued {
    StoreBatch batch;
    std::size_t bytes = 0;
    Done done;
  };

  void run();
  bool wait_for_work(std::unique_lock<std::mutex>& lock);
  void wait_to_retry(std::unique_lock<std::mutex>& lock);
  void commit_some(std::unique_lock<std::mutex>& lock);
  std::size_t group_size() const;
  void succeed(const CommitReport& report);
  void fail(const StoreFailure& failure);
  void give_up();
  void answer(BatchResult result);  // the first in the queue, which leaves it
  void tell_health();
  // Without the mutex: the executor may call back at once.
  void make_calls(std::unique_lock<std::mutex>& lock);

  StoreWorkerConfig config_;
  Dependencies dependencies_;
  Store store_;  // of the worker's thread

  mutable std::mutex mutex_;  // guards what follows, up to status_
  std::condition_variable wake_;
  std::deque<Queued> queue_;  // those in the transaction under way are its first
  bool finishing_ = false;
  StoreStatus status_;

  std::vector<std::function<void()>> calls_;  // of the worker's thread
  std::atomic<bool> beat_requested_{false};
  std::atomic<std::uint64_t> beats_{0};
  std::thread thread_;
};

}  // namespace warren
