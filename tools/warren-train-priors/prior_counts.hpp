// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/layer/model_coder.hpp"

namespace warren {

// How often the bits of each context were set and clear, over many packets. Within a packet a bit
// weighs less the more of its context came before it, as the coder has forgotten its prior by then.
class PriorCounts {
 public:
  PriorCounts();

  // Precondition: the packet is one that a writer made.
  void add(std::span<const std::uint8_t> packet);

  // One byte per context (prior_of). Where little was counted, the first guess shows through.
  std::vector<std::uint8_t> table() const;

  std::uint64_t packets() const { return packets_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  class CountingDecoder;
  struct Count {
    double set = 0.0;
    double clear = 0.0;
    double next_weight = 1.0;
  };

  std::vector<Count> counts_;
  std::uint64_t packets_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace warren
