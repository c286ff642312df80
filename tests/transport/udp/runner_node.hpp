// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>

#include "tests/transport/udp/network_namespace.hpp"
#include "transport/udp/mesh_runner.hpp"

namespace warren::mesh::test {

// Offers map packets of the wanted size, so many, to whoever asks; counts what came of them.
class CountedMap : public MapSource {
 public:
  std::size_t left = 0;
  std::size_t acknowledged = 0;
  std::size_t lost = 0;

  std::optional<Packet> next_for(MemberId to, MapClass wanted, std::size_t limit) override;
  void on_acknowledged(MemberId, std::uint64_t) override { ++acknowledged; }
  void on_lost(MemberId, std::uint64_t) override { ++lost; }
};

// A whole node, on a thread of its own in a namespace.
class RunnerNode {
 public:
  RunnerNode(const NetworkNamespace& where, std::uint32_t member, MeshSocketsConfig sockets);
  ~RunnerNode();

  void post(std::function<void(Endpoint&, MeshTime)> work) { runner_->post(std::move(work)); }
  // For the node's thread only.
  CountedMap& map() { return map_; }
  const MeshSockets& sockets() const { return runner_->sockets(); }
  // True as soon as the events so far fulfil it, within twenty seconds.
  bool until(const std::function<bool(const std::vector<MeshEvent>&)>& condition);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<MeshEvent> events_;
  CountedMap map_;
  asio::io_context io_{1};
  asio::executor_work_guard<asio::io_context::executor_type> running_;
  std::unique_ptr<MeshRunner> runner_;
  std::thread thread_;
};

template <typename Event>
std::size_t count_of(const std::vector<MeshEvent>& events) {
  std::size_t count = 0;
  for (const MeshEvent& event : events) count += std::holds_alternative<Event>(event) ? 1U : 0U;
  return count;
}

}  // namespace warren::mesh::test
