// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include <asio/io_context.hpp>

#include "daemon/warrend.hpp"
#include "tests/daemon/temporary_directory.hpp"
#include "warren/control.pb.h"

namespace warren {

// Holds the mapping thread before each scan while it is shut.
class Gate {
 public:
  void shut();
  void open();
  void pass();  // for the mapping thread
  void wait_until_somebody_waits();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = true;
  bool somebody_waits_ = false;
};

// The whole daemon but main(), on a thread of this process, with sockets in a directory of its own.
class RunningDaemon {
 public:
  explicit RunningDaemon(Config config = {}, Warrend::Dependencies dependencies = {save_map});
  ~RunningDaemon();

  std::filesystem::path ingest_socket() const { return directory_ / "ingest.sock"; }
  std::filesystem::path control_socket() const { return directory_ / "control.sock"; }
  std::filesystem::path file(const std::string& name) const { return directory_ / name; }
  std::filesystem::path config_file() const { return directory_ / "robot.yaml"; }
  // As it was given, with our sockets.
  const Config& config() const { return config_; }

  Gate& gate() { return gate_; }
  void request_stop() { warrend_->request_stop(); }
  void request_reload() { warrend_->request_reload(); }
  // Until io_context::run() has returned.
  void join();
  control::Status status() const;

 private:
  TemporaryDirectory directory_;
  Config config_;
  Gate gate_;
  asio::io_context io_{1};
  std::unique_ptr<Warrend> warrend_;
  std::thread thread_;
};

std::uint64_t count_named(const google::protobuf::RepeatedPtrField<control::Count>& counts,
                          const std::string& name);

}  // namespace warren
