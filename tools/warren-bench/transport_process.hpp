// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace warren {

// A program beside us, whose lines we read. It is killed when this object goes.
class ChildProcess {
 public:
  // The first word is found as by execvp.
  explicit ChildProcess(const std::vector<std::string>& words);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // The next line of its output; nothing if none came until then, or it has ended.
  std::optional<std::string> read_line(std::chrono::steady_clock::time_point until);
  bool has_ended() const { return ended_; }
  void write_line(const std::string& line);
  // Waits until it ends by itself. The CPU time that it took, user and system.
  std::chrono::microseconds wait();
  std::chrono::microseconds kill();

 private:
  pid_t pid_ = -1;
  int input_ = -1;
  int output_ = -1;
  std::string unread_;
  bool ended_ = false;
};

}  // namespace warren
