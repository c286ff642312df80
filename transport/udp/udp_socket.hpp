// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <tl/expected.hpp>

#include "transport/mesh_address.hpp"

namespace warren::mesh {

// Where a UDP socket belongs.
struct SocketPlace {
  std::string interface_name;
  unsigned interface_index = 0;
  bool ipv6 = false;
};

// An open UDP socket that sends and hears on one interface only. Errors are errno values.
class UdpSocket {
 public:
  struct Error {
    const char* call;  // which failed
    int number;
  };
  using Opened = tl::expected<UdpSocket, Error>;

  // For what goes to this node and for all that it sends. Port 0: any that is free. What is sent
  // to groups goes one hop; nothing is fragmented.
  static Opened open_own(const SocketPlace& place, std::uint16_t port, bool group_loop);
  // For what goes to a multicast group (16 bytes, IPv4 mapped), to the broadcast address, or to the
  // group's port. Other processes may have the same.
  static Opened open_group(const SocketPlace& place, const MeshAddress& group);

  ~UdpSocket();
  UdpSocket(UdpSocket&& other) noexcept
      : place_(std::move(other.place_)), descriptor_(std::exchange(other.descriptor_, -1)) {}
  UdpSocket& operator=(UdpSocket&&) = delete;

  void close();  // nothing else may be called then
  int descriptor() const { return descriptor_; }
  std::uint16_t port() const;
  // 0, or why not.
  int send(const MeshAddress& to, std::span<const std::uint8_t> bytes) const;
  struct Received {
    MeshAddress from;
    std::size_t bytes;
  };
  // Nothing waits: EAGAIN.
  tl::expected<Received, int> receive(std::span<std::uint8_t> buffer) const;

 private:
  UdpSocket(SocketPlace place, int descriptor)
      : place_(std::move(place)), descriptor_(descriptor) {}
  static Opened make(const SocketPlace& place);
  std::optional<Error> set(const char* what, int level, int option, int value);
  std::optional<Error> set_sending_options(bool group_loop);
  std::optional<Error> join(const MeshAddress& group);
  std::optional<Error> bind_to(std::uint16_t port);

  SocketPlace place_;
  int descriptor_ = -1;
};

}  // namespace warren::mesh
