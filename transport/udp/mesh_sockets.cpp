// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/mesh_sockets.hpp"

#include <chrono>
#include <utility>
#include <vector>

#include <asio/steady_timer.hpp>

#include "transport/udp/interface_sockets.hpp"
#include "transport/udp/link_watcher.hpp"

namespace warren::mesh {
namespace {

// How often an interface is tried that could not be opened.
constexpr std::chrono::seconds kRetry{1};
constexpr std::size_t kDatagramBytesMax = 65536;

}  // namespace

struct MeshSockets::State : std::enable_shared_from_this<State> {
  State(asio::io_context& io_context, MeshSocketsConfig socket_config, Dependencies parts)
      : io(io_context),
        config(std::move(socket_config)),
        dependencies(std::move(parts)),
        retry(io_context),
        port(config.port) {}

  void start() {
    for (std::size_t i = 0; i < config.interfaces.size(); ++i) add_interface(i);
    const auto on_change = [weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->refresh();
    };
    watcher = std::make_shared<LinkWatcher>(io, on_change);
    watched = watcher->start();
    refresh();
  }

  void add_interface(std::size_t index) {
    const auto path_index = static_cast<InterfaceIndex>(index);
    const auto on_datagram = [this, path_index](const MeshAddress& from, auto bytes) {
      dependencies.on_datagram({path_index, false, from}, bytes);
    };
    interfaces.push_back(std::make_unique<InterfaceSockets>(
        config, config.interfaces[index],
        InterfaceSockets::Dependencies{io, on_datagram, [this] { dependencies.on_idle(); },
                                       buffer}));
  }

  void refresh() {
    if (stopped) return;
    bool complete = watched;
    for (const auto& interface : interfaces) {
      interface->refresh(port);
      if (port == 0) port = interface->port();
      complete = complete && interface->is_complete();
    }
    if (!complete) refresh_later();
  }

  void refresh_later() {
    retry.expires_after(kRetry);
    retry.async_wait([weak = weak_from_this()](const asio::error_code& error) {
      const auto self = weak.lock();
      if (!error && self) self->refresh();
    });
  }

  void stop() {
    if (std::exchange(stopped, true)) return;
    retry.cancel();
    if (watcher) watcher->stop();
    for (const auto& interface : interfaces) interface->close();
  }

  asio::io_context& io;
  MeshSocketsConfig config;
  Dependencies dependencies;
  asio::steady_timer retry;
  std::uint16_t port;
  std::shared_ptr<LinkWatcher> watcher;
  bool watched = false;
  bool stopped = false;
  std::vector<std::uint8_t> buffer = std::vector<std::uint8_t>(kDatagramBytesMax);
  std::vector<std::unique_ptr<InterfaceSockets>> interfaces;
};

MeshSockets::MeshSockets(asio::io_context& io, MeshSocketsConfig config, Dependencies dependencies)
    : state_(std::make_shared<State>(io, std::move(config), std::move(dependencies))) {}

MeshSockets::~MeshSockets() { stop(); }

void MeshSockets::start() { state_->start(); }

void MeshSockets::stop() { state_->stop(); }

void MeshSockets::send(const MeshPath& to, std::span<const std::uint8_t> bytes) {
  InterfaceSockets& interface = *state_->interfaces.at(to.interface);
  if (to.group) {
    interface.send_to_group(bytes);
  } else {
    interface.send(to.address, bytes);
  }
}

bool MeshSockets::is_open(InterfaceIndex interface) const {
  return state_->interfaces.at(interface)->is_open();
}

const std::string& MeshSockets::problem(InterfaceIndex interface) const {
  return state_->interfaces.at(interface)->problem();
}

std::uint16_t MeshSockets::port() const { return state_->port; }

const SocketCounts& MeshSockets::counts(InterfaceIndex interface) const {
  return state_->interfaces.at(interface)->counts();
}

}  // namespace warren::mesh
