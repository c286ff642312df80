// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include <asio/io_context.hpp>

#include "transport/mesh_address.hpp"
#include "transport/udp/mesh_sockets_config.hpp"
#include "transport/udp/socket_counts.hpp"

namespace warren::mesh {

// The UDP sockets of a node. Each interface has its own, bound to it, so that what is meant for it
// leaves there only. Interfaces that come, go or change addresses are followed; nothing throws. All
// calls and callbacks are in the thread that runs the io_context.
class MeshSockets {
 public:
  struct Dependencies {
    // The bytes are valid during the call. The path is where an answer goes: never a group.
    std::function<void(const MeshPath& from, std::span<const std::uint8_t> bytes)> on_datagram;
    // All that was waiting has been handed over.
    std::function<void()> on_idle = [] {};
  };

  MeshSockets(asio::io_context& io, MeshSocketsConfig config, Dependencies dependencies);
  ~MeshSockets();

  void start();
  void stop();

  // At once or never; what became of it is counted.
  void send(const MeshPath& to, std::span<const std::uint8_t> bytes);

  bool is_open(InterfaceIndex interface) const;
  // Why an interface is not open, for people; empty if it is.
  const std::string& problem(InterfaceIndex interface) const;
  std::uint16_t port() const;  // 0: none is open yet
  const SocketCounts& counts(InterfaceIndex interface) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace warren::mesh
