// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <netinet/in.h>

#include "transport/mesh_address.hpp"

namespace warren::mesh {

inline constexpr std::array<std::uint8_t, 12> kMappedPrefix{0, 0, 0, 0, 0,    0,
                                                            0, 0, 0, 0, 0xFF, 0xFF};

inline bool is_ipv4(const MeshAddress& address) {
  return std::equal(kMappedPrefix.begin(), kMappedPrefix.end(), address.ip.begin());
}

inline MeshAddress mapped_address(const std::array<std::uint8_t, 4>& ip, std::uint16_t port) {
  MeshAddress address{{}, port};
  std::copy(kMappedPrefix.begin(), kMappedPrefix.end(), address.ip.begin());
  std::copy(ip.begin(), ip.end(), address.ip.begin() + kMappedPrefix.size());
  return address;
}

// Precondition: is_ipv4().
inline sockaddr_in ipv4_socket_address(const MeshAddress& address) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(address.port);
  std::memcpy(&out.sin_addr, address.ip.data() + kMappedPrefix.size(), sizeof(out.sin_addr));
  return out;
}

// A link-local address means something on one link only: its scope.
inline sockaddr_in6 ipv6_socket_address(const MeshAddress& address, unsigned interface_index) {
  sockaddr_in6 out{};
  out.sin6_family = AF_INET6;
  out.sin6_port = htons(address.port);
  std::memcpy(&out.sin6_addr, address.ip.data(), sizeof(out.sin6_addr));
  if (IN6_IS_ADDR_LINKLOCAL(&out.sin6_addr) || IN6_IS_ADDR_MC_LINKLOCAL(&out.sin6_addr)) {
    out.sin6_scope_id = interface_index;
  }
  return out;
}

inline MeshAddress mesh_address(const sockaddr_in& address) {
  std::array<std::uint8_t, 4> ip{};
  std::memcpy(ip.data(), &address.sin_addr, ip.size());
  return mapped_address(ip, ntohs(address.sin_port));
}

inline MeshAddress mesh_address(const sockaddr_in6& address) {
  MeshAddress out{{}, ntohs(address.sin6_port)};
  std::memcpy(out.ip.data(), &address.sin6_addr, out.ip.size());
  return out;
}

}  // namespace warren::mesh
