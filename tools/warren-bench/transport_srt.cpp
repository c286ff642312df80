// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include <srt.h>
#include <unistd.h>

#include "tools/warren-bench/transport_payload.hpp"
#include "tools/warren-bench/transport_peer_output.hpp"
#include "tools/warren-bench/transport_peers.hpp"

namespace warren {
namespace {

constexpr std::size_t kBufferBytes = 65'536;
constexpr int kPatienceMs = 24 * 3600 * 1000;

void must(bool done, const char* what) {
  if (!done) exit_wrong(std::string(what) + ": " + srt_getlasterror_str());
}

// File mode: reliable bytes in order, its own congestion control.
SRTSOCKET make_socket() {
  must(srt_startup() >= 0, "srt_startup");
  const SRTSOCKET socket = srt_create_socket();
  must(socket != SRT_INVALID_SOCK, "srt_create_socket");
  const SRT_TRANSTYPE type = SRTT_FILE;
  must(srt_setsockflag(socket, SRTO_TRANSTYPE, &type, sizeof(type)) == 0, "SRTO_TRANSTYPE");
  // It would give up after 5 s of silence.
  must(srt_setsockflag(socket, SRTO_PEERIDLETIMEO, &kPatienceMs, sizeof(kPatienceMs)) == 0,
       "SRTO_PEERIDLETIMEO");
  return socket;
}

}  // namespace

void send_by_srt(const TransportPeerOptions& options) {
  const SRTSOCKET socket = make_socket();
  must(srt_setsockflag(socket, SRTO_CONNTIMEO, &kPatienceMs, sizeof(kPatienceMs)) == 0,
       "SRTO_CONNTIMEO");
  const sockaddr_in address = socket_address_of(options);
  print_start();
  must(srt_connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0,
       "srt_connect");
  std::array<std::uint8_t, kBufferBytes> buffer;
  for (std::size_t sent = 0; sent < options.bytes;) {
    const std::span bytes(buffer.data(), std::min(buffer.size(), options.bytes - sent));
    fill_payload(bytes, sent);
    const int taken = srt_send(socket, reinterpret_cast<const char*>(bytes.data()),
                               static_cast<int>(bytes.size()));
    must(taken > 0, "srt_send");
    sent += static_cast<std::size_t>(taken);
  }
  pause();
}

void receive_by_srt(const TransportPeerOptions& options) {
  const SRTSOCKET listener = make_socket();
  const sockaddr_in address = socket_address_of(options);
  must(srt_bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0,
       "srt_bind");
  must(srt_listen(listener, 1) == 0, "srt_listen");
  print_ready();
  const SRTSOCKET socket = srt_accept(listener, nullptr, nullptr);
  must(socket != SRT_INVALID_SOCK, "srt_accept");
  Progress progress(options.bytes);
  std::array<std::uint8_t, kBufferBytes> buffer;
  for (std::size_t offset = 0; !progress.is_complete();) {
    const int got =
        srt_recv(socket, reinterpret_cast<char*>(buffer.data()), static_cast<int>(buffer.size()));
    must(got > 0, "srt_recv");
    const std::span bytes(buffer.data(), static_cast<std::size_t>(got));
    if (!is_payload(bytes, offset)) exit_wrong("other bytes than were sent");
    offset += bytes.size();
    progress.add(bytes.size());
  }
}

}  // namespace warren
