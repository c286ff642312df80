// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "daemon/store/store_batch.hpp"

namespace warren {

// Where the fleet thread writes what must survive a crash. Called on the fleet thread, and calls
// back there.
class StorePort {
 public:
  virtual ~StorePort() = default;
  // Calls `done` once, later: true if all of it is stored now. What is not stored leaves no trace.
  virtual void write(StoreBatch batch, std::function<void(bool)> done) = 0;
};

}  // namespace warren
