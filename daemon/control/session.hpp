// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <asio/local/stream_protocol.hpp>
#include <asio/steady_timer.hpp>

#include "daemon/control/request.hpp"

namespace warren {

// Answers a request with an encoded response, at once or later, on the io_context's thread, once.
// Where the answer may wait for something to happen, what is returned makes it come at once.
using Hurry = std::function<void()>;
using ControlHandler =
    std::function<Hurry(const ControlRequest&, std::function<void(std::string)> respond)>;

// One client of the control socket: one request after the other, each answered before the next is
// read.
class ControlSession : public std::enable_shared_from_this<ControlSession> {
 public:
  using Socket = asio::local::stream_protocol::socket;
  // For a request that has begun to become whole, and for a response to be read.
  static constexpr std::chrono::seconds kMessageTime{5};

  ControlSession(Socket socket, const ControlHandler& handler, std::function<void()> on_closed);

  void start();
  // Says why there is no service, and closes; instead of start().
  void reject(const std::string& text);
  // Closes: at once, or after the response that is being worked on.
  void finish();

 private:
  void watch_for_hangup();
  void hurry();
  void read_length_bytes();
  void read_rest_of_length(std::size_t count);
  void read_body();
  void handle();
  void respond(std::string frame, bool close_after);
  void watch(std::chrono::seconds time);
  void close();

  Socket socket_;
  asio::steady_timer deadline_;
  const ControlHandler& handler_;
  std::function<void()> on_closed_;
  std::array<std::byte, 4> length_{};
  std::vector<std::byte> body_;
  std::string response_;
  Hurry hurry_;  // while an answer may be waited for
  bool hung_up_ = false;
  bool watching_ = false;
  bool working_ = false;
  bool finishing_ = false;
};

}  // namespace warren
