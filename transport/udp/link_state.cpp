// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/link_state.hpp"

#include <cerrno>
#include <memory>

#include <ifaddrs.h>
#include <net/if.h>

#include "transport/udp/socket_address.hpp"

namespace warren::mesh {
namespace {

using Addresses = std::unique_ptr<ifaddrs, decltype(&freeifaddrs)>;

void add(LinkState& state, const ifaddrs& entry) {
  state.up = state.up || (entry.ifa_flags & IFF_UP) != 0;
  state.running = state.running || (entry.ifa_flags & IFF_RUNNING) != 0;
  if (entry.ifa_addr == nullptr) return;
  if (entry.ifa_addr->sa_family == AF_INET6) state.has_ipv6 = true;
  if (entry.ifa_addr->sa_family != AF_INET) return;
  state.has_ipv4 = true;
  if ((entry.ifa_flags & IFF_BROADCAST) == 0 || entry.ifa_broadaddr == nullptr) return;
  sockaddr_in broadcast{};
  std::memcpy(&broadcast, entry.ifa_broadaddr, sizeof(broadcast));
  // A network of one or two addresses has no broadcast address.
  if (broadcast.sin_addr.s_addr != 0) state.broadcasts.push_back(mesh_address(broadcast));
}

}  // namespace

std::optional<LinkState> read_link_state(const std::string& name) {
  LinkState state;
  state.index = if_nametoindex(name.c_str());
  if (state.index == 0) {
    if (errno != ENODEV && errno != ENXIO) return std::nullopt;
    return state;
  }
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return std::nullopt;
  const Addresses addresses(first, &freeifaddrs);
  for (const ifaddrs* entry = first; entry != nullptr; entry = entry->ifa_next) {
    if (name == entry->ifa_name) add(state, *entry);
  }
  return state;
}

}  // namespace warren::mesh
