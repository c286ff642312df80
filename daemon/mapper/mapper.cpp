// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/mapper.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

namespace warren {
namespace {

double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

Mapper::Mapper(const MappingConfig& config, SensorFilters filters, std::size_t queue_scans,
               Dependencies dependencies, StoredMap stored)
    : dependencies_(std::move(dependencies)),
      queue_(queue_scans),
      map_(config),
      filters_(std::move(filters)) {
  map_.restore(std::move(stored));
  thread_ = std::thread([this] { run(); });
}

Mapper::~Mapper() {
  finish([](const auto&) {});
  thread_.join();
}

std::vector<QueuedScan> Mapper::push(QueuedScan scan) {
  const std::lock_guard lock(mutex_);
  work_.notify_one();
  return queue_.push(std::move(scan));
}

bool Mapper::update_pose(const PoseUpdateMessage& update,
                         std::function<void(bool applied)> answer) {
  const std::lock_guard lock(mutex_);
  if (pose_orders_.size() >= kMaxCommands) return false;
  pose_orders_.push_back({queue_.entered(), [this, update, answer = std::move(answer)] {
                            answer(map_.update_pose(update));
                          }});
  work_.notify_one();
  return true;
}

bool Mapper::ask_status(std::function<void(MapperStatus)> answer) {
  return ask([this, answer = std::move(answer)] { answer(status()); });
}

bool Mapper::ask_snapshot(std::function<void(std::shared_ptr<const MapSnapshot>)> answer) {
  return ask([this, answer = std::move(answer)] { answer(map_.snapshot()); });
}

bool Mapper::ask_ground(const GroundQuestion& question,
                        std::function<void(const GroundResult&)> answer) {
  return ask([this, question, answer = std::move(answer)] { answer(map_.ground(question)); });
}

void Mapper::ask_changes(std::function<void(std::vector<LayerChanges>)> answer) {
  post([this, answer = std::move(answer)] { answer(map_.take_changes()); });
}

bool Mapper::ask(std::function<void()> question) {
  const std::lock_guard lock(mutex_);
  if (questions_.size() >= kMaxCommands) return false;
  questions_.push_back(std::move(question));
  work_.notify_one();
  return true;
}

void Mapper::post(std::function<void()> run) {
  const std::lock_guard lock(mutex_);
  own_.push_back(std::move(run));
  work_.notify_one();
}

void Mapper::set_filters(SensorFilters filters) {
  post([this, filters = std::move(filters)] { filters_ = filters; });
}

void Mapper::set_queue_capacity(std::size_t scans) {
  const std::lock_guard lock(mutex_);
  queue_.set_capacity(scans);
}

Mapper::QueueLoad Mapper::queue_load() const {
  const std::lock_guard lock(mutex_);
  return {queue_.size(), queue_.capacity()};
}

void Mapper::request_beat() {
  if (beat_requested_.exchange(true)) return;
  post([this] {
    beat_requested_ = false;
    ++beats_;
  });
}

void Mapper::finish(Finished finished) {
  const std::lock_guard lock(mutex_);
  if (finishing_) return;
  finishing_ = true;
  finished_ = std::move(finished);
  work_.notify_one();
}

bool Mapper::question_is_due() const {
  return !questions_.empty() && (!question_passed_ || queue_.size() == 0);
}

bool Mapper::pose_order_is_due() const {
  return !pose_orders_.empty() && pose_orders_.front().after_scans <= queue_.left();
}

bool Mapper::command_is_due() const {
  return !own_.empty() || question_is_due() || pose_order_is_due();
}

std::function<void()> Mapper::take_command() {
  std::function<void()> command;
  const auto take_from = [&command](std::deque<std::function<void()>>& commands) {
    command = std::move(commands.front());
    commands.pop_front();
  };
  if (!own_.empty()) {
    take_from(own_);
  } else if (question_is_due()) {
    take_from(questions_);
    question_passed_ = true;
  } else if (pose_order_is_due()) {
    command = std::move(pose_orders_.front().run);
    pose_orders_.pop_front();
  }
  return command;
}

bool Mapper::wait_for_work(std::unique_lock<std::mutex>& lock) {
  work_.wait(lock, [this] { return finishing_ || command_is_due() || queue_.size() > 0; });
  return command_is_due() || queue_.size() > 0;
}

void Mapper::run() {
  std::unique_lock lock(mutex_);
  while (wait_for_work(lock)) {
    if (const auto run_command = take_command()) {
      lock.unlock();
      run_command();
    } else {
      auto scan = queue_.pop();
      question_passed_ = false;
      lock.unlock();
      integrate(*scan);
    }
    lock.lock();
  }
  lock.unlock();
  finished_(map_.take_changes());
}

void Mapper::integrate(QueuedScan& scan) {
  dependencies_.before_scan();
  const double before_ms = thread_cpu_ms();
  const ScanReceipt receipt = receipt_of(scan.message);
  if (receipt.outcome == ScanOutcome::kTaken) count_cpu(thread_cpu_ms() - before_ms);
  ++beats_;
  dependencies_.deliver_receipt(scan, receipt);
}

void Mapper::count_cpu(double cpu_ms) {
  ++scans_;
  cpu_ms_sum_ += cpu_ms;
  cpu_ms_max_ = std::max(cpu_ms_max_, cpu_ms);
}

ScanReceipt Mapper::receipt_of(ScanMessage& message) {
  const auto filter = filters_.find(message.sensor);
  if (filter == filters_.end()) {
    return {message.sequence, ScanOutcome::kRejected,
            map_.reject(Rejection::kSensorRemoved).value(), 0};
  }
  const auto used = map_.integrate(std::move(message.scan), message.frame_epoch, filter->second);
  if (!used) return {message.sequence, ScanOutcome::kRejected, used.error(), 0};
  return {message.sequence, ScanOutcome::kTaken, {}, *used};
}

MapperStatus Mapper::status() const {
  MapperStatus status;
  status.map = map_.info();
  status.rejected_points = map_.rejected();
  status.scans = scans_;
  if (scans_ > 0) status.integrate_cpu_ms_mean = cpu_ms_sum_ / static_cast<double>(scans_);
  status.integrate_cpu_ms_max = cpu_ms_max_;
  return status;
}

}  // namespace warren
