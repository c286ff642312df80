// SPDX-License-Identifier: Apache-2.0
#include "tests/transport/udp/socket_node.hpp"

#include <algorithm>
#include <chrono>
#include <future>

#include <asio/post.hpp>

namespace warren::mesh::test {
namespace {

constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kBetweenLooks{20};

}  // namespace

SocketNode::SocketNode(const NetworkNamespace& where, MeshSocketsConfig config)
    : running_(asio::make_work_guard(io_)) {
  const auto on_datagram = [this](const MeshPath& from, std::span<const std::uint8_t> bytes) {
    const std::lock_guard lock(mutex_);
    heard_.push_back({from, {bytes.begin(), bytes.end()}});
    changed_.notify_all();
  };
  sockets_ = std::make_unique<MeshSockets>(io_, std::move(config),
                                           MeshSockets::Dependencies{on_datagram, [] {}});
  thread_ = std::thread([this, &where] {
    where.enter();
    io_.run();
  });
  run([this] { sockets_->start(); });
}

SocketNode::~SocketNode() {
  run([this] { sockets_->stop(); });
  running_.reset();
  thread_.join();
}

void SocketNode::run(const std::function<void()>& work) {
  std::promise<void> done;
  asio::post(io_, [&] {
    work();
    done.set_value();
  });
  done.get_future().wait();
}

void SocketNode::send(const MeshPath& to, const std::string& text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  run([&] { sockets_->send(to, bytes); });
}

bool SocketNode::has_heard(const std::string& text) {
  return std::any_of(heard_.begin(), heard_.end(),
                     [&](const Heard& heard) { return heard.text == text; });
}

std::vector<SocketNode::Heard> SocketNode::heard_until(const std::string& text) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kPatience, [&] { return has_heard(text); });
  return heard_;
}

bool SocketNode::until(const std::function<bool(const MeshSockets&)>& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    bool met = false;
    run([&] { met = condition(*sockets_); });
    if (met) return true;
    std::this_thread::sleep_for(kBetweenLooks);
  }
  return false;
}

bool SocketNode::reaches_by_group(SocketNode& other, const std::string& text) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    send({0, true, {}}, text);
    std::unique_lock lock(other.mutex_);
    if (other.changed_.wait_for(lock, kBetweenLooks, [&] { return other.has_heard(text); })) {
      return true;
    }
  }
  return false;
}

SocketCounts SocketNode::counts() {
  SocketCounts counts;
  run([&] { counts = sockets_->counts(0); });
  return counts;
}

std::uint16_t SocketNode::port() {
  std::uint16_t port = 0;
  run([&] { port = sockets_->port(); });
  return port;
}

}  // namespace warren::mesh::test
