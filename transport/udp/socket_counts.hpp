// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace warren::mesh {

// Of one interface. A datagram that could not be sent is as if the radio had lost it.
struct SocketCounts {
  std::uint64_t sent = 0;  // datagrams that the kernel took; a group datagram counts per address
  std::uint64_t received = 0;
  std::uint64_t bytes_sent = 0;  // of UDP payload
  std::uint64_t bytes_received = 0;
  std::uint64_t opened = 0;  // times that the sockets were made, groups joined
  std::uint64_t open_failed = 0;
  // Why a datagram was not sent:
  std::uint64_t interface_down = 0;  // or not there, or without an address of the family
  std::uint64_t too_large = 0;       // EMSGSIZE
  std::uint64_t unreachable = 0;     // ENETUNREACH and its like
  std::uint64_t buffers_full = 0;    // EAGAIN, ENOBUFS
  std::uint64_t not_permitted = 0;   // EPERM: a packet filter
  std::uint64_t send_failed = 0;     // any other error
  std::uint64_t receive_failed = 0;
};

// By the errno of a send.
void count_send_failure(SocketCounts& counts, int error);

}  // namespace warren::mesh
