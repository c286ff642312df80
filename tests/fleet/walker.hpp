// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/layer/coded_block.hpp"
#include "core/layer/replica.hpp"
#include "tools/world/random.hpp"

namespace warren::fleet_sim {

// A robot that wanders through a tunnel and maps what is around it: each step changes a few
// neighbouring blocks, some of them again and again.
class Walker {
 public:
  struct Config {
    std::uint32_t blocks_per_step = 3;
    std::uint32_t voxels_per_block = 40;
    double emptied = 0.02;  // share of blocks that become unknown again
  };
  Walker(const Config& config, std::uint64_t seed) : config_(config), random_(seed) {
    at_ = {static_cast<std::int32_t>(random_.below(40)) - 20,
           static_cast<std::int32_t>(random_.below(40)) - 20, 0};
  }

  // The blocks as they are after the next step.
  std::vector<CodedBlock> step(const Replica& layer);
  BlockKey at() const { return at_; }

 private:
  void scribble(BlockCodes& codes);

  Config config_;
  world::Random random_;
  BlockKey at_;
};

}  // namespace warren::fleet_sim
