// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>

#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/steady_timer.hpp>

#include "daemon/control/session.hpp"

namespace warren {

// The control socket: hands every request to the handler. On the io_context's one thread.
class ControlServer {
 public:
  static constexpr std::size_t kMaxClients = 16;

  // `listening` is a descriptor that listens already; the server closes it.
  ControlServer(asio::io_context& io, int listening, ControlHandler handler);

  void start() { accept(); }
  // No new clients; each one there is closed after its present request.
  void finish();

 private:
  void accept();
  void add(ControlSession::Socket socket);

  asio::local::stream_protocol::acceptor acceptor_;
  asio::steady_timer accept_again_;
  ControlHandler handler_;
  std::uint64_t last_client_ = 0;
  std::map<std::uint64_t, std::shared_ptr<ControlSession>> sessions_;
  bool stopping_ = false;
};

}  // namespace warren
