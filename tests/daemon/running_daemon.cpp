// SPDX-License-Identifier: Apache-2.0
#include "tests/daemon/running_daemon.hpp"

#include "tests/daemon/test_client.hpp"

namespace warren {

void Gate::shut() {
  const std::lock_guard lock(mutex_);
  is_open_ = false;
}

void Gate::open() {
  const std::lock_guard lock(mutex_);
  is_open_ = true;
  changed_.notify_all();
}

void Gate::pass() {
  std::unique_lock lock(mutex_);
  somebody_waits_ = true;
  changed_.notify_all();
  changed_.wait(lock, [this] { return is_open_; });
  somebody_waits_ = false;
}

void Gate::wait_until_somebody_waits() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return somebody_waits_; });
}

RunningDaemon::RunningDaemon(Config config, Warrend::Dependencies dependencies)
    : config_(std::move(config)) {
  start_log(LogLevel::kOff, LogFormat::kText);
  config_.sockets.ingest.path = ingest_socket();
  config_.sockets.control.path = control_socket();
  if (config_.store.file == Config{}.store.file) config_.store.file = file("warren.db");
  dependencies.before_scan = [this] { gate_.pass(); };
  auto started = Warrend::start(io_, config_, config_file(), std::move(dependencies));
  REQUIRE_MESSAGE(started.has_value(), started.error());
  warrend_ = std::move(*started);
  thread_ = std::thread([this] { io_.run(); });
}

RunningDaemon::~RunningDaemon() {
  gate_.open();
  request_stop();
  join();
}

void RunningDaemon::join() {
  if (thread_.joinable()) thread_.join();
}

control::Status RunningDaemon::status() const {
  control::Request request;
  request.mutable_status();
  return TestClient(control_socket()).ask(request).status();
}

std::uint64_t count_named(const google::protobuf::RepeatedPtrField<control::Count>& counts,
                          const std::string& name) {
  for (const auto& count : counts) {
    if (count.name() == name) return count.count();
  }
  FAIL("no count named ", name);
  return 0;
}

}  // namespace warren
