// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/mesh_runner.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include <asio/post.hpp>
#include <asio/steady_timer.hpp>

namespace warren::mesh {
namespace {

// So that sending does not keep the node from reading: the rest goes after the next turn.
constexpr int kSendsPerTurn = 128;
// A deadline that is over is served after this: other handlers have their turn.
constexpr Duration kWaitMin{20};
constexpr Duration kWaitMax = std::chrono::hours(1);

// A group datagram goes once to each kind of address that the interface has.
EndpointConfig with_group_copies(const MeshRunner::Config& config) {
  assert(config.endpoint.interfaces.size() == config.sockets.interfaces.size());
  EndpointConfig endpoint = config.endpoint;
  for (std::size_t i = 0; i < endpoint.interfaces.size(); ++i) {
    const SocketInterface& sockets = config.sockets.interfaces[i];
    const int copies = sockets.ipv4 + sockets.ipv6 + (sockets.ipv4 && sockets.broadcast);
    endpoint.interfaces[i].group_copies = static_cast<std::size_t>(copies);
  }
  return endpoint;
}

}  // namespace

struct MeshRunner::State : std::enable_shared_from_this<State> {
  State(asio::io_context& io_context, const Config& config, std::shared_ptr<const KeySchedule> keys,
        MapSource& source, OnEvent handler)
      : io(io_context),
        on_event(std::move(handler)),
        endpoint(with_group_copies(config), std::move(keys), source),
        sockets(io, config.sockets, socket_dependencies()),
        timer(io) {}

  MeshSockets::Dependencies socket_dependencies() {
    return {[this](const MeshPath& from, std::span<const std::uint8_t> bytes) {
              endpoint.on_datagram(now(), from, bytes);
              hand_over_events();
            },
            [this] { run(); }};
  }

  void run() {
    if (stopped || std::exchange(running, true)) return;
    hand_over_events();
    const bool more = transmit();
    hand_over_events();
    running = false;
    if (more) {
      run_soon();
    } else {
      wait_for_deadline();
    }
  }

  void hand_over_events() {
    while (auto event = stopped ? std::nullopt : endpoint.poll_event()) {
      on_event(std::move(*event));
    }
  }

  // True if there may be more.
  bool transmit() {
    for (int i = 0; i < kSendsPerTurn; ++i) {
      const auto datagram = stopped ? std::nullopt : endpoint.poll_transmit(now());
      if (!datagram) return false;
      sockets.send(datagram->to, datagram->bytes);
    }
    return true;
  }

  void run_soon() {
    asio::post(io, [weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->run();
    });
  }

  void wait_for_deadline() {
    if (stopped) return;
    const MeshTime time = now();
    const MeshTime deadline =
        std::clamp(endpoint.next_deadline(), time + kWaitMin, time + kWaitMax);
    // An earlier one that still waits costs one turn; setting the timer anew, two system calls.
    if (timer_set && deadline >= timer.expiry() && timer.expiry() > time) return;
    timer_set = true;
    timer.expires_at(deadline);
    timer.async_wait([weak = weak_from_this()](const asio::error_code& error) {
      const auto self = weak.lock();
      if (error || !self) return;
      self->timer_set = false;
      self->run();
    });
  }

  void stop() {
    if (std::exchange(stopped, true)) return;
    timer.cancel();
    sockets.stop();
  }

  asio::io_context& io;
  OnEvent on_event;
  Endpoint endpoint;
  MeshSockets sockets;
  asio::steady_timer timer;
  bool timer_set = false;
  bool running = false;
  bool stopped = false;
};

MeshRunner::MeshRunner(asio::io_context& io, const Config& config,
                       std::shared_ptr<const KeySchedule> keys, MapSource& source, OnEvent on_event)
    : state_(std::make_shared<State>(io, config, std::move(keys), source, std::move(on_event))) {}

MeshRunner::~MeshRunner() { stop(); }

void MeshRunner::start() {
  state_->sockets.start();
  state_->run();
}

void MeshRunner::stop() { state_->stop(); }

void MeshRunner::post(std::function<void(Endpoint& endpoint, MeshTime now)> work) {
  asio::post(state_->io, [weak = std::weak_ptr(state_), work = std::move(work)] {
    const auto state = weak.lock();
    if (!state || state->stopped) return;
    work(state->endpoint, now());
    state->run();
  });
}

Endpoint& MeshRunner::endpoint() { return state_->endpoint; }

void MeshRunner::run() { state_->run(); }

const MeshSockets& MeshRunner::sockets() const { return state_->sockets; }

MeshTime MeshRunner::now() {
  return std::chrono::time_point_cast<Duration>(std::chrono::steady_clock::now());
}

}  // namespace warren::mesh
