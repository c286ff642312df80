// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>

namespace warren {

// Position of an interface in the node's configuration.
using InterfaceIndex = std::uint8_t;

// IPv6, or IPv4 mapped into it (::ffff:a.b.c.d).
struct MeshAddress {
  std::array<std::uint8_t, 16> ip{};
  std::uint16_t port = 0;
  friend auto operator<=>(const MeshAddress&, const MeshAddress&) = default;
};

// Where a datagram goes to or comes from. A group datagram goes to all who hear it on the
// interface (multicast and broadcast): its address means nothing.
struct MeshPath {
  InterfaceIndex interface = 0;
  bool group = false;
  MeshAddress address;
  friend auto operator<=>(const MeshPath&, const MeshPath&) = default;
};

}  // namespace warren
