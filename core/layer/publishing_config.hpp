// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/layer/publisher.hpp"

namespace warren {

struct PublishingConfig {
  SenderRules rules;
  std::size_t packet_bytes = 1200;
  // So many ticks without a change, and what the rules hold back is published.
  std::uint32_t flush_after_ticks = 30;
};

}  // namespace warren
