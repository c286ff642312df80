// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <asio/io_context.hpp>

#include "transport/mesh_address.hpp"
#include "transport/udp/link_state.hpp"
#include "transport/udp/mesh_sockets_config.hpp"
#include "transport/udp/socket_counts.hpp"
#include "transport/udp/socket_reader.hpp"

namespace warren::mesh {

// The sockets of one interface: per address family one for the node itself and one for the group.
// They are made anew whenever the interface, its carrier or its addresses come back, as that may
// have cost them their place in the group.
class InterfaceSockets {
 public:
  struct Dependencies {
    asio::io_context& io;
    std::function<void(const MeshAddress& from, std::span<const std::uint8_t> bytes)> on_datagram;
    std::function<void()> on_idle;
    std::span<std::uint8_t> buffer;  // for any datagram
  };

  InterfaceSockets(const MeshSocketsConfig& config, SocketInterface interface,
                   Dependencies dependencies);

  // Looks at the interface and follows it. `port` is that of the node, 0: any.
  void refresh(std::uint16_t port);
  void close();

  void send(const MeshAddress& to, std::span<const std::uint8_t> bytes);
  void send_to_group(std::span<const std::uint8_t> bytes);

  bool is_open() const { return ipv4_.is_open() || ipv6_.is_open(); }
  // Nothing of what was asked for is missing.
  bool is_complete() const;
  std::uint16_t port() const;
  const SocketCounts& counts() const { return counts_; }
  // Why it is not open; empty if it is.
  const std::string& problem() const { return problem_; }

 private:
  struct Presence {
    unsigned index = 0;
    bool up = false, running = false, has_address = false;
    friend bool operator==(const Presence&, const Presence&) = default;
  };
  struct Family {
    bool ipv6 = false;
    bool wanted = false;
    MeshAddress group;
    Presence seen;
    std::shared_ptr<SocketReader> own, of_group;
    bool is_open() const { return own != nullptr; }
    bool can_send() const { return own != nullptr && seen.has_address; }
  };

  void follow(Family& family, const Presence& presence, std::uint16_t port);
  void open(Family& family, std::uint16_t port);
  void close(Family& family);
  std::shared_ptr<SocketReader> reader(UdpSocket socket);  // null: it cannot be watched
  void note(const UdpSocket::Error& error);
  void read(const SocketReader& from);
  void send_from(const Family& family, const MeshAddress& to, std::span<const std::uint8_t> bytes);

  SocketInterface interface_;
  Dependencies dependencies_;
  bool group_loop_;
  Family ipv4_, ipv6_;
  bool looked_ = false;  // the kernel told of the interface when it was asked last
  std::vector<MeshAddress> broadcasts_;
  std::uint16_t group_port_;
  SocketCounts counts_;
  std::string problem_;
};

}  // namespace warren::mesh
