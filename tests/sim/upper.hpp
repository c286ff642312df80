// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "transport/endpoint/endpoint.hpp"

namespace warren::mesh::sim {

// What stands above the endpoints instead of the simulation's own load: a whole node's other parts.
// Times are by the node's clock.
class Upper {
 public:
  virtual ~Upper() = default;
  // The endpoint is about to be made, or has just been.
  virtual MapSource& on_start(MeshTime now, std::size_t node) = 0;
  virtual void on_started(MeshTime now, std::size_t node, Endpoint& endpoint) = 0;
  virtual void on_stop(std::size_t node) = 0;
  virtual void on_event(MeshTime now, std::size_t node, MeshEvent&& event) = 0;
  // Before the endpoint is asked for datagrams.
  virtual void on_turn(MeshTime now, std::size_t node, Endpoint& endpoint) = 0;
  // When on_turn() has something to do without an event.
  virtual MeshTime next_turn(std::size_t node) const = 0;
  virtual std::size_t memory_bytes(std::size_t node) const = 0;
};

}  // namespace warren::mesh::sim
