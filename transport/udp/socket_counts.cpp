// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/socket_counts.hpp"

#include <cerrno>

namespace warren::mesh {

void count_send_failure(SocketCounts& counts, int error) {
  switch (error) {
    case EMSGSIZE:
      ++counts.too_large;
      return;
    case ENETUNREACH:
    case EHOSTUNREACH:
    case ENETDOWN:
    case EHOSTDOWN:
    case EADDRNOTAVAIL:
    case ENODEV:
    case ENXIO:
      ++counts.unreachable;
      return;
    case EAGAIN:
    case ENOBUFS:
    case ENOMEM:
      ++counts.buffers_full;
      return;
    case EPERM:
    case EACCES:
      ++counts.not_permitted;
      return;
    default:
      ++counts.send_failed;
  }
}

}  // namespace warren::mesh
