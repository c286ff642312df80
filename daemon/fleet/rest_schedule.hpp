// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "core/layer/replica.hpp"

namespace warren {

// Since which revision of a layer a region must be unchanged to be laid to rest. It remembers a few
// past ticks, so a region waits for `after_ticks`, or up to an eighth more.
class RestSchedule {
 public:
  explicit RestSchedule(std::uint32_t after_ticks) : after_ticks_(after_ticks) {}

  // At every tick, with the layer's revision after it. What has not changed since the revision that
  // is returned may rest; 0: nothing may.
  Revision tick(Revision now);
  std::size_t marks() const { return marks_.size(); }

 private:
  struct Mark {
    std::uint64_t tick = 0;
    Revision revision;
  };

  std::uint64_t after_ticks_;
  std::uint64_t ticks_ = 0;
  std::deque<Mark> marks_;  // oldest first
};

// One tick of a layer: packs at most `most` of its regions that are due; how many it did.
std::size_t rest_quiet_regions(Replica& layer, RestSchedule& schedule, std::size_t most);

}  // namespace warren
