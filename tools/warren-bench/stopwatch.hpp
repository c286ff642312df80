// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

#include "tools/warren-bench/cpu_clock.hpp"

namespace warren {

// Adds up the CPU time, user and system, that the calling thread spends on pieces of work.
class Stopwatch {
 public:
  template <typename Work>
  decltype(auto) time(Work&& work) {
    const Lap lap(seconds_);
    return std::forward<Work>(work)();
  }
  double ms_per(std::size_t count) const {
    return count == 0 ? 0.0 : 1e3 * seconds_ / static_cast<double>(count);
  }

 private:
  class Lap {
   public:
    explicit Lap(double& seconds) : seconds_(seconds), start_(thread_cpu_s()) {}
    ~Lap() { seconds_ += thread_cpu_s() - start_; }
    Lap(const Lap&) = delete;
    Lap& operator=(const Lap&) = delete;

   private:
    double& seconds_;
    double start_;
  };

  double seconds_ = 0.0;
};

}  // namespace warren
