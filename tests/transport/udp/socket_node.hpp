// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>

#include "tests/transport/udp/network_namespace.hpp"
#include "transport/udp/mesh_sockets.hpp"

namespace warren::mesh::test {

// The sockets of a node, on a thread of its own in a namespace.
class SocketNode {
 public:
  struct Heard {
    MeshPath from;
    std::string text;
  };

  SocketNode(const NetworkNamespace& where, MeshSocketsConfig config);
  ~SocketNode();

  void send(const MeshPath& to, const std::string& text);
  // Everything heard so far, as soon as `text` is among it; what is heard within ten seconds
  // without it.
  std::vector<Heard> heard_until(const std::string& text);
  // True as soon as it is, within ten seconds. The condition is looked at in the node's thread.
  bool until(const std::function<bool(const MeshSockets&)>& condition);
  // Sends a text to the group again and again, until the other one has heard it.
  bool reaches_by_group(SocketNode& other, const std::string& text);

  SocketCounts counts();
  std::uint16_t port();

 private:
  void run(const std::function<void()>& work);
  bool has_heard(const std::string& text);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Heard> heard_;
  asio::io_context io_{1};
  asio::executor_work_guard<asio::io_context::executor_type> running_;
  std::unique_ptr<MeshSockets> sockets_;
  std::thread thread_;
};

}  // namespace warren::mesh::test
