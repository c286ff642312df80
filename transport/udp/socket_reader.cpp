// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/socket_reader.hpp"

#include <utility>

namespace warren::mesh {

SocketReader::SocketReader(asio::io_context& io, UdpSocket socket, OnReadable on_readable)
    : socket_(std::move(socket)), waiter_(io), on_readable_(std::move(on_readable)) {}

SocketReader::~SocketReader() { stop(); }

std::error_code SocketReader::start() {
  asio::error_code error;
  waiter_.assign(socket_.descriptor(), error);
  if (error) {
    stop();
  } else {
    wait();
  }
  return error;
}

void SocketReader::wait() {
  waiter_.async_wait(asio::posix::stream_descriptor::wait_read,
                     [self = shared_from_this()](const asio::error_code& error) {
                       if (error || self->stopped_) return;
                       self->on_readable_(*self);
                       if (!self->stopped_) self->wait();
                     });
}

void SocketReader::stop() {
  if (std::exchange(stopped_, true)) return;
  // The descriptor belongs to the socket. It goes now and not with the last handler that holds us:
  // the next socket wants its port.
  if (waiter_.is_open()) waiter_.release();
  socket_.close();
}

}  // namespace warren::mesh
