// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace warren {

// What a peer process tells the benchmark; see run_transport_peer().
void print_ready();
void print_start();
[[noreturn]] void exit_unavailable(const std::string& why);
[[noreturn]] void exit_wrong(const std::string& why);

class Progress {
 public:
  explicit Progress(std::size_t total_bytes) : total_(total_bytes) {}
  void add(std::size_t bytes);
  bool is_complete() const { return have_ >= total_; }

 private:
  std::size_t total_;
  std::size_t have_ = 0;
  std::int64_t printed_us_ = 0;
};

}  // namespace warren
