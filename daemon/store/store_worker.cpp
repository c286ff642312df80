// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/store_worker.hpp"

#include <utility>
#include <vector>

namespace warren {

StoreWorker::StoreWorker(Store store, const StoreWorkerConfig& config, Dependencies dependencies)
    : config_(config),
      dependencies_(std::move(dependencies)),
      store_(std::move(store)),
      thread_([this] { run(); }) {}

StoreWorker::~StoreWorker() {
  {
    const std::lock_guard lock(mutex_);
    finishing_ = true;
    wake_.notify_one();
  }
  thread_.join();
}

bool StoreWorker::submit(StoreBatch batch, Done done) {
  const std::size_t bytes = batch.memory_bytes();
  const std::lock_guard lock(mutex_);
  const bool has_room = queue_.size() < config_.queue_batches_max &&
                        (queue_.empty() || status_.bytes_queued + bytes <= config_.queue_bytes_max);
  if (!has_room) {
    ++status_.batches_refused;
    return false;
  }
  queue_.push_back({std::move(batch), bytes, std::move(done)});
  status_.bytes_queued += bytes;
  wake_.notify_one();
  return true;
}

StoreStatus StoreWorker::status() const {
  const std::lock_guard lock(mutex_);
  StoreStatus status = status_;
  status.batches_queued = queue_.size();
  return status;
}

void StoreWorker::request_beat() {
  const std::lock_guard lock(mutex_);
  beat_requested_ = true;
  wake_.notify_one();
}

void StoreWorker::run() {
  std::unique_lock lock(mutex_);
  status_.usage = store_.usage();
  while (wait_for_work(lock)) {
    commit_some(lock);
    const bool failing = status_.health.failing.has_value();
    if (failing && finishing_) give_up();
    make_calls(lock);
    if (failing) wait_to_retry(lock);
  }
}

bool StoreWorker::wait_for_work(std::unique_lock<std::mutex>& lock) {
  while (queue_.empty() && !finishing_) {
    if (beat_requested_.exchange(false)) ++beats_;
    wake_.wait(lock, [this] { return !queue_.empty() || finishing_ || beat_requested_; });
  }
  return !queue_.empty();
}

void StoreWorker::wait_to_retry(std::unique_lock<std::mutex>& lock) {
  const auto until = std::chrono::steady_clock::now() + config_.retry_after;
  while (!finishing_ && std::chrono::steady_clock::now() < until) {
    if (beat_requested_.exchange(false)) ++beats_;
    wake_.wait_until(lock, until, [this] { return finishing_ || beat_requested_; });
  }
}

// The mutex is not held while the disk works; what is queued meanwhile comes behind.
void StoreWorker::commit_some(std::unique_lock<std::mutex>& lock) {
  if (beat_requested_.exchange(false)) ++beats_;
  std::vector<const StoreBatch*> batches(group_size());
  for (std::size_t i = 0; i < batches.size(); ++i) batches[i] = &queue_[i].batch;
  lock.unlock();
  const auto report = store_.commit(batches);
  const StoreUsage usage = store_.usage();
  lock.lock();
  status_.usage = usage;
  report ? succeed(*report) : fail(report.error());
}

std::size_t StoreWorker::group_size() const {
  std::size_t count = 1;
  // What has been refused is tried in the smallest portions.
  if (status_.health.failing) return count;
  std::size_t bytes = queue_.front().bytes;
  while (count < queue_.size() && bytes + queue_[count].bytes <= config_.transaction_bytes_max) {
    bytes += queue_[count++].bytes;
  }
  return count;
}

void StoreWorker::succeed(const CommitReport& report) {
  ++status_.transactions;
  for (const BatchResult result : report.results) answer(result);
  status_.layers_evicted += report.evicted.layers.size();
  status_.items_evicted += report.evicted.items.size();
  status_.writes_dropped += report.evicted.writes_dropped;
  if (!report.evicted.layers.empty() || !report.evicted.items.empty()) {
    calls_.push_back(
        [tell = dependencies_.on_evicted, evicted = report.evicted] { tell(evicted); });
  }
  const bool was_failing = status_.health.failing.has_value();
  status_.health = {};
  if (was_failing) tell_health();
}

void StoreWorker::fail(const StoreFailure& failure) {
  ++status_.transactions_failed;
  const bool is_news = !status_.health.failing || status_.health.failing->error != failure.error;
  status_.health = {failure, status_.health.failed_in_a_row + 1};
  if (is_news) tell_health();
}

void StoreWorker::give_up() {
  while (!queue_.empty()) answer(BatchResult::kGivenUp);
}

void StoreWorker::answer(BatchResult result) {
  ++status_.results[static_cast<std::size_t>(result)];
  Queued& first = queue_.front();
  status_.bytes_queued -= first.bytes;
  calls_.push_back([done = std::move(first.done), result] { done(result); });
  queue_.pop_front();
}

void StoreWorker::tell_health() {
  calls_.push_back([tell = dependencies_.on_health, health = status_.health] { tell(health); });
}

void StoreWorker::make_calls(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  for (auto& call : calls_) dependencies_.post(std::move(call));
  calls_.clear();
  lock.lock();
}

}  // namespace warren
