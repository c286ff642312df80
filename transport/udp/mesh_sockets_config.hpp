// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace warren::mesh {

// How one network interface is used. It need not exist yet, and may come and go.
struct SocketInterface {
  std::string name;  // as the system calls it: wlan0
  bool ipv4 = true;
  bool ipv6 = false;
  // Group datagrams also go to the directed broadcast address of IPv4: for radios that pass no
  // multicast.
  bool broadcast = false;
};

struct MeshSocketsConfig {
  std::vector<SocketInterface> interfaces;  // MeshPath::interface counts in this order
  // Of this node alone; 0: any that is free. Several nodes on one host need different ones.
  std::uint16_t port = 7718;
  // Of the whole fleet: group datagrams go there, and seeds may name it.
  std::uint16_t group_port = 7717;
  std::array<std::uint8_t, 4> group_ipv4{239, 77, 82, 78};
  std::array<std::uint8_t, 16> group_ipv6{0xFF, 0x02, 0, 0, 0, 0, 0,    0,
                                          0,    0,    0, 0, 0, 0, 0x77, 0x17};
  bool group_loop = false;  // other nodes on this host hear the group datagrams too
};

}  // namespace warren::mesh
