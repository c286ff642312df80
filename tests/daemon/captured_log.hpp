// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include "daemon/log.hpp"
#include "tests/daemon/temporary_directory.hpp"

namespace warren {

// The warnings of this process while this lives. To be made after the daemons, which start the log.
class CapturedLog {
 public:
  CapturedLog() : stderr_before_(dup(STDERR_FILENO)) {
    const int file = open(file_.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0600);
    REQUIRE(dup2(file, STDERR_FILENO) == STDERR_FILENO);
    close(file);
    set_log_level(LogLevel::kWarning);
  }
  ~CapturedLog() {
    set_log_level(LogLevel::kOff);
    dup2(stderr_before_, STDERR_FILENO);
    close(stderr_before_);
  }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  std::string text() const {
    std::ifstream file(file_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "log";
  int stderr_before_;
};

}  // namespace warren
