// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/udp_socket.hpp"

#include <cerrno>

#include <sys/socket.h>
#include <unistd.h>

#include "transport/udp/socket_address.hpp"

namespace warren::mesh {
namespace {

// At 100 Mbit/s this is 80 ms that the process may be kept from reading.
constexpr int kReceiveBufferBytes = 1 << 20;

template <typename Address>
const sockaddr* generic(const Address& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

ssize_t send_to(int descriptor, std::span<const std::uint8_t> bytes, const sockaddr* to,
                socklen_t length) {
  return sendto(descriptor, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL, to, length);
}

}  // namespace

UdpSocket::~UdpSocket() { close(); }

void UdpSocket::close() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

UdpSocket::Opened UdpSocket::make(const SocketPlace& place) {
  const int family = place.ipv6 ? AF_INET6 : AF_INET;
  UdpSocket made(place, socket(family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (made.descriptor_ < 0) return tl::unexpected(Error{"socket", errno});
  const std::string& name = place.interface_name;
  if (setsockopt(made.descriptor_, SOL_SOCKET, SO_BINDTODEVICE, name.c_str(),
                 static_cast<socklen_t>(name.size())) != 0) {
    return tl::unexpected(Error{"SO_BINDTODEVICE", errno});
  }
  if (place.ipv6) {
    if (auto error = made.set("IPV6_V6ONLY", IPPROTO_IPV6, IPV6_V6ONLY, 1)) {
      return tl::unexpected(*error);
    }
  }
  // The kernel gives what it allows.
  setsockopt(made.descriptor_, SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes,
             sizeof(kReceiveBufferBytes));
  return made;
}

UdpSocket::Opened UdpSocket::open_own(const SocketPlace& place, std::uint16_t port,
                                      bool group_loop) {
  auto made = make(place);
  if (!made) return made;
  if (auto error = made->set_sending_options(group_loop)) return tl::unexpected(*error);
  if (auto error = made->bind_to(port)) return tl::unexpected(*error);
  return made;
}

UdpSocket::Opened UdpSocket::open_group(const SocketPlace& place, const MeshAddress& group) {
  auto made = make(place);
  if (!made) return made;
  if (auto error = made->set("SO_REUSEADDR", SOL_SOCKET, SO_REUSEADDR, 1)) {
    return tl::unexpected(*error);
  }
  if (auto error = made->bind_to(group.port)) return tl::unexpected(*error);
  if (auto error = made->join(group)) return tl::unexpected(*error);
  return made;
}

std::optional<UdpSocket::Error> UdpSocket::set(const char* what, int level, int option, int value) {
  if (setsockopt(descriptor_, level, option, &value, sizeof(value)) == 0) return std::nullopt;
  return Error{what, errno};
}

std::optional<UdpSocket::Error> UdpSocket::set_sending_options(bool group_loop) {
  struct Option {
    const char* what;
    int level, option, value;
  };
  const int index = static_cast<int>(place_.interface_index);
  const int loop = group_loop ? 1 : 0;
  // PROBE: never fragmented, and never refused because of what a router once said of the path.
  const std::array<Option, 4> ipv6{{
      {"IPV6_MTU_DISCOVER", IPPROTO_IPV6, IPV6_MTU_DISCOVER, IPV6_PMTUDISC_PROBE},
      {"IPV6_MULTICAST_IF", IPPROTO_IPV6, IPV6_MULTICAST_IF, index},
      {"IPV6_MULTICAST_HOPS", IPPROTO_IPV6, IPV6_MULTICAST_HOPS, 1},
      {"IPV6_MULTICAST_LOOP", IPPROTO_IPV6, IPV6_MULTICAST_LOOP, loop},
  }};
  const std::array<Option, 4> ipv4{{
      {"IP_MTU_DISCOVER", IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_PROBE},
      {"IP_MULTICAST_TTL", IPPROTO_IP, IP_MULTICAST_TTL, 1},
      {"IP_MULTICAST_LOOP", IPPROTO_IP, IP_MULTICAST_LOOP, loop},
      {"SO_BROADCAST", SOL_SOCKET, SO_BROADCAST, 1},
  }};
  for (const Option& option : place_.ipv6 ? ipv6 : ipv4) {
    if (auto error = set(option.what, option.level, option.option, option.value)) return error;
  }
  if (place_.ipv6) return std::nullopt;
  ip_mreqn out{};
  out.imr_ifindex = index;
  if (setsockopt(descriptor_, IPPROTO_IP, IP_MULTICAST_IF, &out, sizeof(out)) == 0) {
    return std::nullopt;
  }
  return Error{"IP_MULTICAST_IF", errno};
}

std::optional<UdpSocket::Error> UdpSocket::join(const MeshAddress& group) {
  // Else the socket hears whatever group anybody on this machine has joined.
  const int level = place_.ipv6 ? IPPROTO_IPV6 : IPPROTO_IP;
  if (auto error =
          set("MULTICAST_ALL", level, place_.ipv6 ? IPV6_MULTICAST_ALL : IP_MULTICAST_ALL, 0)) {
    return error;
  }
  int failed = 0;
  if (place_.ipv6) {
    ipv6_mreq membership{};
    membership.ipv6mr_multiaddr = ipv6_socket_address(group, 0).sin6_addr;
    membership.ipv6mr_interface = place_.interface_index;
    failed = setsockopt(descriptor_, level, IPV6_JOIN_GROUP, &membership, sizeof(membership));
  } else {
    ip_mreqn membership{};
    membership.imr_multiaddr = ipv4_socket_address(group).sin_addr;
    membership.imr_ifindex = static_cast<int>(place_.interface_index);
    failed = setsockopt(descriptor_, level, IP_ADD_MEMBERSHIP, &membership, sizeof(membership));
  }
  if (failed == 0) return std::nullopt;
  return Error{"joining the group", errno};
}

std::optional<UdpSocket::Error> UdpSocket::bind_to(std::uint16_t port) {
  int failed = 0;
  if (place_.ipv6) {
    const sockaddr_in6 any = ipv6_socket_address({{}, port}, 0);
    failed = bind(descriptor_, generic(any), sizeof(any));
  } else {
    const sockaddr_in any = ipv4_socket_address(mapped_address({}, port));
    failed = bind(descriptor_, generic(any), sizeof(any));
  }
  if (failed == 0) return std::nullopt;
  return Error{"bind", errno};
}

std::uint16_t UdpSocket::port() const {
  sockaddr_storage name{};
  socklen_t length = sizeof(name);
  if (getsockname(descriptor_, reinterpret_cast<sockaddr*>(&name), &length) != 0) return 0;
  if (place_.ipv6) return ntohs(reinterpret_cast<const sockaddr_in6&>(name).sin6_port);
  return ntohs(reinterpret_cast<const sockaddr_in&>(name).sin_port);
}

int UdpSocket::send(const MeshAddress& to, std::span<const std::uint8_t> bytes) const {
  ssize_t sent = 0;
  do {
    if (place_.ipv6) {
      const sockaddr_in6 address = ipv6_socket_address(to, place_.interface_index);
      sent = send_to(descriptor_, bytes, generic(address), sizeof(address));
    } else {
      const sockaddr_in address = ipv4_socket_address(to);
      sent = send_to(descriptor_, bytes, generic(address), sizeof(address));
    }
  } while (sent < 0 && errno == EINTR);
  return sent < 0 ? errno : 0;
}

tl::expected<UdpSocket::Received, int> UdpSocket::receive(std::span<std::uint8_t> buffer) const {
  sockaddr_storage from{};
  ssize_t got = 0;
  do {
    socklen_t length = sizeof(from);
    got = recvfrom(descriptor_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from),
                   &length);
  } while (got < 0 && errno == EINTR);
  if (got < 0) return tl::unexpected(errno);
  const MeshAddress address = place_.ipv6
                                  ? mesh_address(reinterpret_cast<const sockaddr_in6&>(from))
                                  : mesh_address(reinterpret_cast<const sockaddr_in&>(from));
  return Received{address, static_cast<std::size_t>(got)};
}

}  // namespace warren::mesh
