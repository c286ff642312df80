// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/post.hpp>

#include "daemon/fleet/store_port.hpp"
#include "daemon/fleet/store_rows.hpp"

namespace warren::test {

// Answers at once, as it is told to.
class ScriptedStore final : public StorePort {
 public:
  explicit ScriptedStore(asio::io_context& io) : io_(io) {}
  void write(StoreBatch batch, std::function<void(bool)> done) override {
    if (stores) keep(batch);
    batches.push_back(std::move(batch));
    asio::post(io_, [done = std::move(done), stores = stores] { done(stores); });
  }
  // As a restart would find them.
  std::vector<replication::StoredLog> logs() const {
    std::vector<LogItem> items;
    for (const auto& [id, item] : items_) items.push_back(item);
    return logs_of(items, states_).logs;
  }

  std::vector<StoreBatch> batches;
  bool stores = true;

 private:
  void keep(const StoreBatch& batch) {
    for (const LogItemId& id : batch.erased_items) items_.erase(id);
    for (const LogItem& item : batch.items) items_.insert_or_assign(item.id, item);
    for (const auto& [name, bytes] : batch.states) states_[name] = bytes;
  }

  asio::io_context& io_;
  std::map<LogItemId, LogItem> items_;
  std::map<std::string, std::vector<std::uint8_t>> states_;
};

}  // namespace warren::test
