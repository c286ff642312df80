// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <system_error>

#include <asio/io_context.hpp>
#include <asio/posix/stream_descriptor.hpp>

#include "transport/udp/udp_socket.hpp"

namespace warren::mesh {

// Says when a socket has something to read, until it is stopped.
class SocketReader : public std::enable_shared_from_this<SocketReader> {
 public:
  using OnReadable = std::function<void(const SocketReader&)>;

  SocketReader(asio::io_context& io, UdpSocket socket, OnReadable on_readable);
  ~SocketReader();

  // An error: it cannot be watched, and is stopped.
  std::error_code start();
  void stop();
  bool is_stopped() const { return stopped_; }
  const UdpSocket& socket() const { return socket_; }

 private:
  void wait();

  UdpSocket socket_;
  asio::posix::stream_descriptor waiter_;
  OnReadable on_readable_;
  bool stopped_ = false;
};

}  // namespace warren::mesh
