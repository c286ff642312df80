// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/replication/replication.hpp"
#include "daemon/store/store_batch.hpp"

namespace warren {

// What replication wants stored, as the store has it: layers with their blocks; items of logs with
// their numbers; and one state per log, which says what of it counts no more.
StoreBatch rows_of(const replication::StoreBatch& batch);

// Logs from their rows. What contradicts itself is left out, and counted.
struct StoredLogs {
  std::vector<replication::StoredLog> logs;
  std::uint64_t refused = 0;
};
StoredLogs logs_of(const std::vector<LogItem>& items,
                   const std::map<std::string, std::vector<std::uint8_t>>& states);

}  // namespace warren
