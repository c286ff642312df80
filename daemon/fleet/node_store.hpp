// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <asio/io_context.hpp>

#include "daemon/fleet/store_port.hpp"
#include "daemon/store/store_worker.hpp"

namespace warren {

// The node's store, written by a thread of its own. While the disk refuses, a batch waits and is
// tried again: nothing is lost but time.
class NodeStore final : public StorePort {
 public:
  // Callbacks run on the io_context, which must outlive this.
  NodeStore(asio::io_context& io, Store store);
  void write(StoreBatch batch, std::function<void(bool)> done) override;
  StoreWorker& worker() { return worker_; }
  const StoreWorker& worker() const { return worker_; }

 private:
  StoreWorker worker_;
};

}  // namespace warren
