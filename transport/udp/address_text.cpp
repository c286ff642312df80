// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/address_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include <arpa/inet.h>

#include "transport/udp/socket_address.hpp"

namespace warren::mesh {
namespace {

std::optional<std::uint16_t> parse_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc() || end != text.data() + text.size() || port == 0) return std::nullopt;
  return port;
}

std::optional<MeshAddress> parse_ipv4(const std::string& host, std::uint16_t port) {
  std::array<std::uint8_t, 4> ip{};
  if (inet_pton(AF_INET, host.c_str(), ip.data()) != 1) return std::nullopt;
  return mapped_address(ip, port);
}

std::optional<MeshAddress> parse_ipv6(const std::string& host, std::uint16_t port) {
  if (host.size() < 2 || host.front() != '[' || host.back() != ']') return std::nullopt;
  MeshAddress address{{}, port};
  const std::string inner = host.substr(1, host.size() - 2);
  if (inet_pton(AF_INET6, inner.c_str(), address.ip.data()) != 1) return std::nullopt;
  return address;
}

}  // namespace

std::optional<MeshAddress> parse_mesh_address(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto port = parse_port(text.substr(colon + 1));
  if (!port) return std::nullopt;
  const std::string host(text.substr(0, colon));
  const auto ipv4 = parse_ipv4(host, *port);
  return ipv4 ? ipv4 : parse_ipv6(host, *port);
}

std::string to_text(const MeshAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> host{};
  const bool ipv4 = is_ipv4(address);
  const std::uint8_t* ip = address.ip.data() + (ipv4 ? kMappedPrefix.size() : 0);
  inet_ntop(ipv4 ? AF_INET : AF_INET6, ip, host.data(), host.size());
  std::string text = host.data();
  if (!ipv4) text.insert(0, 1, '[').push_back(']');
  return text.append(1, ':').append(std::to_string(address.port));
}

}  // namespace warren::mesh
