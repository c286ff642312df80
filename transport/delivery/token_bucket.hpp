// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

#include "transport/mesh_time.hpp"

namespace warren::mesh {

// A share of a rate in bytes, saved up to `burst_bytes`. What is taken may exceed what is there by
// one taking: then the bucket is in debt.
class TokenBucket {
 public:
  explicit TokenBucket(double burst_bytes) : tokens_(burst_bytes) {}

  void refill(MeshTime now, double bytes_per_s, double burst_bytes) {
    const double seconds = std::chrono::duration<double>(now - filled_).count();
    if (started_) tokens_ += std::max(0.0, seconds) * bytes_per_s;
    tokens_ = std::min(tokens_, burst_bytes);
    filled_ = now;
    started_ = true;
  }
  void take(double bytes) { tokens_ -= bytes; }
  bool open() const { return tokens_ > 0.0; }
  double tokens() const { return tokens_; }

 private:
  double tokens_;
  MeshTime filled_;
  bool started_ = false;
};

}  // namespace warren::mesh
