// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/node_store.hpp"

#include <string>
#include <utility>

#include <asio/post.hpp>

#include "daemon/log.hpp"

namespace warren {
namespace {

void log_health(const StoreHealth& health) {
  if (health.failing) {
    log_error("store: the disk takes nothing, so nothing new leaves this node; trying again: " +
              health.failing->text);
  } else {
    log_info("store: the disk takes again what it is given");
  }
}

void log_evictions(const Evictions& evicted) {
  if (!evicted.layers.empty()) {
    log_warning("store: no room: copies of " + std::to_string(evicted.layers.size()) +
                " layers of others are kept in memory only");
  }
  if (!evicted.items.empty()) {
    log_warning("store: no room: " + std::to_string(evicted.items.size()) +
                " messages of others are kept in memory only");
  }
}

}  // namespace

NodeStore::NodeStore(asio::io_context& io, Store store)
    : worker_(std::move(store), {},
              {[&io](std::function<void()> call) { asio::post(io, std::move(call)); }, log_health,
               log_evictions}) {}

void NodeStore::write(StoreBatch batch, std::function<void(bool)> done) {
  auto answer = [done](BatchResult result) {
    if (result != BatchResult::kStored) {
      log_error(std::string("store: not stored: ") + text_of(result));
    }
    done(result == BatchResult::kStored);
  };
  if (!worker_.submit(std::move(batch), std::move(answer))) done(false);
}

}  // namespace warren
