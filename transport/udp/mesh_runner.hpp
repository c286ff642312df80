// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include <asio/io_context.hpp>

#include "transport/endpoint/endpoint.hpp"
#include "transport/udp/mesh_sockets.hpp"

namespace warren::mesh {

// One endpoint on real sockets: datagrams in and out, its deadlines, its events. Everything happens
// in the thread that runs the io_context. Events are handed over before anything more is sent, so
// what the handler stores is stored before the other side hears of it.
class MeshRunner {
 public:
  struct Config {
    // Its interfaces in the same order as those of the sockets, which also set their group_copies.
    EndpointConfig endpoint;
    MeshSocketsConfig sockets;
  };
  using OnEvent = std::function<void(MeshEvent event)>;

  MeshRunner(asio::io_context& io, const Config& config, std::shared_ptr<const KeySchedule> keys,
             MapSource& source, OnEvent on_event);
  ~MeshRunner();  // not from within the handler

  void start();
  void stop();

  // From any thread: the work is done in ours, then the endpoint sends what it may.
  void post(std::function<void(Endpoint& endpoint, MeshTime now)> work);

  // In the io_context's thread only. Whoever changes something calls run() after it, but not the
  // handler of events, after which that happens anyway.
  Endpoint& endpoint();
  void run();
  const MeshSockets& sockets() const;

  static MeshTime now();  // of the steady clock

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace warren::mesh
