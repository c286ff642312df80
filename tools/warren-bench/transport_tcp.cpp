// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tools/warren-bench/transport_payload.hpp"
#include "tools/warren-bench/transport_peer_output.hpp"
#include "tools/warren-bench/transport_peers.hpp"

namespace warren {
namespace {

constexpr std::size_t kBufferBytes = 65'536;

void must(bool done, const char* what) {
  if (!done) exit_wrong(std::string(what) + ": " + std::strerror(errno));
}

}  // namespace

void send_by_tcp(const TransportPeerOptions& options, const char* congestion_control) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  must(socket >= 0, "socket");
  if (setsockopt(socket, IPPROTO_TCP, TCP_CONGESTION, congestion_control,
                 static_cast<socklen_t>(std::strlen(congestion_control))) != 0) {
    exit_unavailable(std::string("the kernel has no ") + congestion_control);
  }
  const sockaddr_in address = socket_address_of(options);
  print_start();
  must(connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0,
       "connect");
  std::array<std::uint8_t, kBufferBytes> buffer;
  for (std::size_t sent = 0; sent < options.bytes;) {
    const std::span bytes(buffer.data(), std::min(buffer.size(), options.bytes - sent));
    fill_payload(bytes, sent);
    const ssize_t taken = send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    must(taken > 0, "send");
    sent += static_cast<std::size_t>(taken);
  }
  pause();
}

void receive_by_tcp(const TransportPeerOptions& options) {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = socket_address_of(options);
  must(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0, "bind");
  must(listen(listener, 1) == 0, "listen");
  print_ready();
  const int socket = accept(listener, nullptr, nullptr);
  must(socket >= 0, "accept");
  Progress progress(options.bytes);
  std::array<std::uint8_t, kBufferBytes> buffer;
  for (std::size_t offset = 0; !progress.is_complete();) {
    const ssize_t got = recv(socket, buffer.data(), buffer.size(), 0);
    must(got > 0, "recv");
    const std::span bytes(buffer.data(), static_cast<std::size_t>(got));
    if (!is_payload(bytes, offset)) exit_wrong("other bytes than were sent");
    offset += bytes.size();
    progress.add(bytes.size());
  }
}

}  // namespace warren
