// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <tl/expected.hpp>

#include "daemon/fleet/fleet.hpp"

namespace warren {

// Answers those who keep a copy of the map: at once if it lacks something, else when it does, or
// when they do not want to wait any longer. Nothing is kept for a client between its questions: its
// cursor says all, so one that is slow costs nothing and is told the newest state when it comes
// back. On the io_context's thread.
class Subscriptions {
 public:
  // A client asks one question at a time, so there are no more waits than clients.
  Subscriptions(asio::io_context& io, Fleet& fleet);

  using Respond = std::function<void(std::string)>;
  // What it returns, if anything, ends the wait: the answer then comes at once.
  std::function<void()> answer(const BlocksQuestion& question, const Respond& respond);

 private:
  using Clock = std::chrono::steady_clock;
  using Result = tl::expected<BlocksAnswer, std::string>;
  struct Wait {
    Wait(asio::io_context& io, const BlocksQuestion& asked, Respond told)
        : question(asked), respond(std::move(told)), timer(io) {}

    BlocksQuestion question;
    Respond respond;
    asio::steady_timer timer;
    Clock::time_point until;
    bool is_over = false;
  };
  using SharedWait = std::shared_ptr<Wait>;

  void look_later(const SharedWait& wait);
  void look(const SharedWait& wait);
  void on_look(const SharedWait& wait, const Result& result);

  asio::io_context& io_;
  Fleet& fleet_;
  std::uint64_t run_;
};

}  // namespace warren
