// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/server.hpp"

#include "daemon/socket_file.hpp"

namespace warren {

ControlServer::ControlServer(asio::io_context& io, int listening, ControlHandler handler)
    : acceptor_(io, asio::local::stream_protocol(), listening),
      accept_again_(io),
      handler_(std::move(handler)) {}

void ControlServer::accept() {
  acceptor_.async_accept([this](std::error_code error, ControlSession::Socket socket) {
    if (stopping_) return;
    if (!error) {
      add(std::move(socket));
      return accept();
    }
    accept_again_.expires_after(kAcceptPause);
    accept_again_.async_wait([this](std::error_code cancelled) {
      if (!cancelled && !stopping_) accept();
    });
  });
}

void ControlServer::add(ControlSession::Socket socket) {
  const bool is_one_too_many = sessions_.size() >= kMaxClients;
  const std::uint64_t id = ++last_client_;
  const auto session = std::make_shared<ControlSession>(std::move(socket), handler_,
                                                        [this, id] { sessions_.erase(id); });
  sessions_[id] = session;
  if (is_one_too_many) {
    session->reject("too many clients on the control socket; close one");
  } else {
    session->start();
  }
}

void ControlServer::finish() {
  stopping_ = true;
  std::error_code ignored;
  acceptor_.close(ignored);
  accept_again_.cancel();
  const auto sessions = sessions_;
  for (const auto& [id, session] : sessions) session->finish();
}

}  // namespace warren
