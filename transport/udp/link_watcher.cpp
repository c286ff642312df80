// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/link_watcher.hpp"

#include <array>
#include <cerrno>
#include <utility>

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <unistd.h>

namespace warren::mesh {

LinkWatcher::LinkWatcher(asio::io_context& io, std::function<void()> on_change)
    : socket_(io), on_change_(std::move(on_change)) {}

bool LinkWatcher::start() {
  const int descriptor = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_ROUTE);
  if (descriptor < 0) return false;
  sockaddr_nl groups{};
  groups.nl_family = AF_NETLINK;
  groups.nl_groups = RTMGRP_LINK | RTMGRP_IPV4_IFADDR | RTMGRP_IPV6_IFADDR;
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&groups), sizeof(groups)) != 0) {
    close(descriptor);
    return false;
  }
  asio::error_code error;
  socket_.assign(descriptor, error);
  if (error) {
    close(descriptor);
    return false;
  }
  wait();
  return true;
}

void LinkWatcher::stop() {
  asio::error_code ignored;
  socket_.close(ignored);
}

void LinkWatcher::wait() {
  const auto read = [self = shared_from_this()](const asio::error_code& error) {
    if (error || !self->socket_.is_open()) return;
    self->drain();
    self->on_change_();
    if (self->socket_.is_open()) self->wait();
  };
  socket_.async_wait(asio::posix::stream_descriptor::wait_read, read);
}

// What changed does not matter, nor do messages that the kernel had no room for (ENOBUFS): whoever
// is told looks at everything.
void LinkWatcher::drain() {
  std::array<char, 8192> message;
  while (true) {
    const ssize_t got = recv(socket_.native_handle(), message.data(), message.size(), 0);
    if (got < 0 && errno != ENOBUFS && errno != EINTR) return;
  }
}

}  // namespace warren::mesh
