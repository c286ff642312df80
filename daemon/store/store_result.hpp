// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/store/store_batch.hpp"

namespace warren {

// What became of a batch. Only a stored one may be acknowledged.
enum class BatchResult : std::uint8_t {
  kStored,           // except for layers and items that were evicted to make room
  kRevisionReused,   // of an own layer: not above what is stored
  kLayerClosed,      // of an own layer that must not be continued (StartReport::rolled_back)
  kHoldingsLowered,  // of another's layer, without having been forgotten
  kSequenceReused,   // an own item whose number is taken
  kTooManyItems,     // kLogItemsMax, and none may be evicted
  kUnsound,          // numbers that contradict each other, or what is stored
  kGivenUp,          // the worker ended while the disk refused
};
inline constexpr std::size_t kBatchResults = 8;
const char* text_of(BatchResult result);

struct Evictions {
  std::vector<LayerId> layers;  // of others: from now on not stored until the next start
  std::vector<LogItemId> items;
  std::uint64_t writes_dropped = 0;  // to layers evicted before
};

struct CommitReport {
  std::vector<BatchResult> results;  // one for each batch; those not stored left no trace
  Evictions evicted;
};

}  // namespace warren
