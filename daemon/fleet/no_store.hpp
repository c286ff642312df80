// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

#include <asio/io_context.hpp>
#include <asio/post.hpp>

#include "daemon/fleet/store_port.hpp"

namespace warren {

// A node without a store: all counts as stored, and a restart begins anew, under new incarnations.
class NoStore final : public StorePort {
 public:
  explicit NoStore(asio::io_context& io) : io_(io) {}
  void write(StoreBatch, std::function<void(bool)> done) override {
    asio::post(io_, [done = std::move(done)] { done(true); });
  }

 private:
  asio::io_context& io_;
};

}  // namespace warren
