// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace warren {

// One side of one transport in a process of its own, run by the benchmark within a namespace.
struct TransportPeerOptions {
  std::string kind;  // see transport_kinds()
  bool sends = false;
  std::string address;  // of the receiver
  std::uint16_t port = 5000;
  std::size_t bytes = 0;
};

const std::vector<std::string>& transport_kinds();
// Those of them that can run beside any other in the same namespaces.
std::vector<std::string> rival_kinds();

// It prints lines, times in microseconds of the monotonic clock:
//   ready             the receiver can be sent to
//   start TIME        the sender begins
//   at TIME BYTES     so many bytes of the payload have arrived, checked (some times a millisecond
//                     at most)
//   unavailable WHY   this kernel cannot
//   wrong WHY         the payload is not what was sent, or the connection broke
// The receiver ends when it has all; the sender stays until it is killed.
int run_transport_peer(const TransportPeerOptions& options);

}  // namespace warren
