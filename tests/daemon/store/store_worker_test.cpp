// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/store_worker.hpp"

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include "tests/daemon/store/fault_vfs.hpp"
#include "tests/daemon/store/opened_store.hpp"
#include "tests/daemon/store/store_scenario.hpp"
#include "tests/daemon/temporary_directory.hpp"

using namespace warren;
using namespace warren::test;

namespace {

// Takes calls from the worker's thread and makes them on the test's.
class Executor {
 public:
  void post(std::function<void()> call) {
    const std::lock_guard lock(mutex_);
    calls_.push_back(std::move(call));
    called_.notify_one();
  }
  template <typename Condition>
  void run_until(Condition&& condition) {
    std::unique_lock lock(mutex_);
    while (!condition()) {
      called_.wait(lock, [this] { return !calls_.empty(); });
      const auto call = std::move(calls_.front());
      calls_.pop_front();
      lock.unlock();
      call();
      lock.lock();
    }
  }
  void run_all() {
    run_until([this] { return calls_.empty(); });
  }

 private:
  std::mutex mutex_;
  std::condition_variable called_;
  std::deque<std::function<void()>> calls_;
};

struct Heard {
  std::vector<BatchResult> results;
  std::vector<StoreHealth> health;
  std::vector<Evictions> evicted;
};

StoreWorker::Dependencies listening(Executor& executor, Heard& heard) {
  return {[&executor](std::function<void()> call) { executor.post(std::move(call)); },
          [&heard](const StoreHealth& health) { heard.health.push_back(health); },
          [&heard](const Evictions& evicted) { heard.evicted.push_back(evicted); }};
}

StoreWorker::Done noting(Heard& heard) {
  return [&heard](BatchResult result) { heard.results.push_back(result); };
}

}  // namespace

TEST_CASE("batches are stored in order, callbacks come by the executor, many share a transaction") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  StoreScenario scenario(1);
  Executor executor;
  Heard heard;
  {
    StoreWorker worker(std::move(opened(config).store), {}, listening(executor, heard));
    for (int i = 0; i < 50; ++i) REQUIRE(worker.submit(scenario.step(), noting(heard)));
    CHECK(heard.results.empty());  // nothing is called but by the executor
    executor.run_until([&] { return heard.results.size() == 50; });
    const StoreStatus status = worker.status();
    CHECK(status.transactions < 50);
    CHECK(status.batches_queued == 0);
    CHECK(status.bytes_queued == 0);
    CHECK(status.results[static_cast<std::size_t>(BatchResult::kStored)] == 50);
  }
  CHECK(heard.results == std::vector<BatchResult>(50, BatchResult::kStored));
  CHECK(heard.health.empty());
  Store store = std::move(opened(config).store);
  CHECK(scenario.difference(store) == "");
}

TEST_CASE("the end waits for what is queued") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  StoreScenario scenario(2);
  Executor executor;
  Heard heard;
  {
    StoreWorker worker(std::move(opened(config).store), {}, listening(executor, heard));
    for (int i = 0; i < 30; ++i) REQUIRE(worker.submit(scenario.step(), noting(heard)));
  }
  executor.run_all();
  CHECK(heard.results == std::vector<BatchResult>(30, BatchResult::kStored));
  Store store = std::move(opened(config).store);
  CHECK(scenario.difference(store) == "");
}

TEST_CASE("while the disk refuses the queue fills, then submit refuses; afterwards all is stored") {
  const TemporaryDirectory directory;
  FaultVfs disk(3);
  const StoreConfig config = small_config(directory / "store.db", disk.name());
  StoreScenario scenario(3);
  Executor executor;
  Heard heard;
  std::uint64_t accepted = 0;
  {
    Store store = std::move(opened(config).store);
    disk.set_capacity(disk.bytes());
    StoreWorkerConfig worker_config;
    worker_config.queue_batches_max = 8;
    worker_config.retry_after = std::chrono::milliseconds(1);
    StoreWorker worker(std::move(store), worker_config, listening(executor, heard));
    StoreBatch next = scenario.step();
    for (; worker.submit(next, noting(heard)); next = scenario.step()) ++accepted;
    CHECK(accepted >= 8);
    executor.run_until([&] { return !heard.health.empty(); });
    REQUIRE(heard.health[0].failing);
    CHECK(heard.health[0].failing->error == StoreError::kDiskFull);
    CHECK(worker.status().health.failing);
    CHECK(worker.status().batches_refused == 1);
    const std::size_t stored_before = heard.results.size();
    CHECK(stored_before <= accepted);

    disk.set_capacity(~std::uint64_t{0});
    executor.run_until([&] { return heard.results.size() == accepted; });
    executor.run_until([&] { return heard.health.size() == 2; });
    CHECK_FALSE(heard.health[1].failing);
    CHECK_FALSE(worker.status().health.failing);
    // The batch that was refused is the caller's still.
    while (!worker.submit(next, noting(heard))) {
    }
    executor.run_until([&] { return heard.results.size() == accepted + 1; });
  }
  CHECK(heard.results == std::vector<BatchResult>(accepted + 1, BatchResult::kStored));
  Store store = std::move(opened(config).store);
  CHECK(steps_in(store) == scenario.steps());
}

TEST_CASE("a disk that refuses to the end costs what was never acknowledged, and says so") {
  const TemporaryDirectory directory;
  FaultVfs disk(4);
  const StoreConfig config = small_config(directory / "store.db", disk.name());
  StoreScenario scenario(4);
  Executor executor;
  Heard heard;
  {
    Store store = std::move(opened(config).store);
    disk.power_off_after(0);
    StoreWorkerConfig worker_config;
    worker_config.retry_after = std::chrono::hours(1);  // the end does not wait for it
    StoreWorker worker(std::move(store), worker_config, listening(executor, heard));
    for (int i = 0; i < 3; ++i) REQUIRE(worker.submit(scenario.step(), noting(heard)));
    executor.run_until([&] { return !heard.health.empty(); });
    CHECK(heard.results.empty());
  }
  executor.run_all();
  CHECK(heard.results == std::vector<BatchResult>(3, BatchResult::kGivenUp));
}

TEST_CASE("the worker beats when asked, idle or failing") {
  const TemporaryDirectory directory;
  FaultVfs disk(5);
  Executor executor;
  Heard heard;
  StoreScenario scenario(5);
  StoreWorkerConfig worker_config;
  worker_config.retry_after = std::chrono::hours(1);
  StoreWorker worker(std::move(opened(small_config(directory / "store.db", disk.name())).store),
                     worker_config, listening(executor, heard));
  const auto await_beat = [&] {
    const std::uint64_t before = worker.beats();
    worker.request_beat();
    while (worker.beats() == before) std::this_thread::yield();
  };
  await_beat();
  disk.power_off_after(0);
  REQUIRE(worker.submit(scenario.step(), noting(heard)));
  executor.run_until([&] { return !heard.health.empty(); });
  await_beat();
}
