// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/interface_sockets.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include "transport/udp/socket_address.hpp"

namespace warren::mesh {
namespace {

// So that reading does not keep the node from sending: the rest comes after the next turn.
constexpr int kReadsPerTurn = 64;

}  // namespace

InterfaceSockets::InterfaceSockets(const MeshSocketsConfig& config, SocketInterface interface,
                                   Dependencies dependencies)
    : interface_(std::move(interface)),
      dependencies_(std::move(dependencies)),
      group_loop_(config.group_loop),
      group_port_(config.group_port) {
  ipv4_.wanted = interface_.ipv4;
  ipv4_.group = mapped_address(config.group_ipv4, config.group_port);
  ipv6_.ipv6 = true;
  ipv6_.wanted = interface_.ipv6;
  ipv6_.group = {config.group_ipv6, config.group_port};
}

void InterfaceSockets::refresh(std::uint16_t port) {
  const auto state = read_link_state(interface_.name);
  looked_ = state.has_value();
  if (!state) {
    if (!is_open()) problem_ = "nothing is known of " + interface_.name;
    return;
  }
  const LinkState& link = *state;
  broadcasts_ = link.broadcasts;
  problem_.clear();
  if (link.index == 0) problem_ = "there is no interface " + interface_.name;
  if (link.index != 0 && !link.up) problem_ = interface_.name + " is down";
  follow(ipv4_, {link.index, link.up, link.running, link.has_ipv4}, port);
  const std::uint16_t same_port = port != 0 ? port : this->port();
  follow(ipv6_, {link.index, link.up, link.running, link.has_ipv6}, same_port);
}

void InterfaceSockets::follow(Family& family, const Presence& presence, std::uint16_t port) {
  if (!family.wanted || (family.is_open() && family.seen == presence)) return;
  close(family);
  family.seen = presence;
  if (presence.up) open(family, port);
}

void InterfaceSockets::open(Family& family, std::uint16_t port) {
  const SocketPlace place{interface_.name, family.seen.index, family.ipv6};
  auto own = UdpSocket::open_own(place, port, group_loop_);
  if (!own) return note(own.error());
  auto of_group = UdpSocket::open_group(place, family.group);
  if (!of_group) return note(of_group.error());
  family.own = reader(std::move(*own));
  family.of_group = reader(std::move(*of_group));
  if (!family.own || !family.of_group) return close(family);
  ++counts_.opened;
}

void InterfaceSockets::note(const UdpSocket::Error& error) {
  ++counts_.open_failed;
  problem_ =
      interface_.name + ": " + error.call + ": " + std::system_category().message(error.number);
}

std::shared_ptr<SocketReader> InterfaceSockets::reader(UdpSocket socket) {
  auto made = std::make_shared<SocketReader>(dependencies_.io, std::move(socket),
                                             [this](const SocketReader& from) { read(from); });
  if (const std::error_code error = made->start()) {
    note({"epoll_ctl", error.value()});
    return nullptr;
  }
  return made;
}

void InterfaceSockets::read(const SocketReader& from) {
  for (int i = 0; i < kReadsPerTurn && !from.is_stopped(); ++i) {
    const auto received = from.socket().receive(dependencies_.buffer);
    if (!received) {
      if (received.error() == EAGAIN) break;
      ++counts_.receive_failed;
      continue;
    }
    ++counts_.received;
    counts_.bytes_received += received->bytes;
    dependencies_.on_datagram(received->from, dependencies_.buffer.first(received->bytes));
  }
  if (!from.is_stopped()) dependencies_.on_idle();
}

void InterfaceSockets::close() {
  close(ipv4_);
  close(ipv6_);
}

void InterfaceSockets::close(Family& family) {
  for (auto* reader : {&family.own, &family.of_group}) {
    if (*reader) (*reader)->stop();
    reader->reset();
  }
}

void InterfaceSockets::send(const MeshAddress& to, std::span<const std::uint8_t> bytes) {
  const Family& family = is_ipv4(to) ? ipv4_ : ipv6_;
  if (!family.can_send()) {
    ++counts_.interface_down;
    return;
  }
  send_from(family, to, bytes);
}

void InterfaceSockets::send_to_group(std::span<const std::uint8_t> bytes) {
  if (!ipv4_.can_send() && !ipv6_.can_send()) {
    ++counts_.interface_down;
    return;
  }
  for (const Family* family : {&ipv4_, &ipv6_}) {
    if (family->can_send()) send_from(*family, family->group, bytes);
  }
  if (!interface_.broadcast || !ipv4_.can_send()) return;
  for (MeshAddress broadcast : broadcasts_) {
    broadcast.port = group_port_;
    send_from(ipv4_, broadcast, bytes);
  }
}

void InterfaceSockets::send_from(const Family& family, const MeshAddress& to,
                                 std::span<const std::uint8_t> bytes) {
  if (const int error = family.own->socket().send(to, bytes)) {
    count_send_failure(counts_, error);
    return;
  }
  ++counts_.sent;
  counts_.bytes_sent += bytes.size();
}

bool InterfaceSockets::is_complete() const {
  const auto complete = [](const Family& family) { return !family.wanted || family.is_open(); };
  return looked_ && complete(ipv4_) && complete(ipv6_);
}

std::uint16_t InterfaceSockets::port() const {
  if (ipv4_.is_open()) return ipv4_.own->socket().port();
  return ipv6_.is_open() ? ipv6_.own->socket().port() : std::uint16_t{0};
}

}  // namespace warren::mesh
