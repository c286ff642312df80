// SPDX-License-Identifier: Apache-2.0
#include "tests/transport/udp/runner_node.hpp"

#include <chrono>
#include <random>

#include <asio/post.hpp>

namespace warren::mesh::test {
namespace {

constexpr std::chrono::seconds kPatience{20};
const Key kFleetKey{7};

MeshRunner::Config config_of(std::uint32_t member, MeshSocketsConfig sockets) {
  std::random_device random;
  MeshRunner::Config config;
  config.endpoint.self = {member};
  config.endpoint.boot = {std::uint64_t{random()} << 32 | random()};
  config.endpoint.random_seed = member;
  config.endpoint.interfaces.resize(sockets.interfaces.size());
  config.sockets = std::move(sockets);
  return config;
}

}  // namespace

std::optional<MapSource::Packet> CountedMap::next_for(MemberId, MapClass wanted,
                                                      std::size_t limit) {
  if (left == 0 || wanted != MapClass::kBacklog) return std::nullopt;
  --left;
  return Packet{left, wanted, std::vector<std::uint8_t>(limit, 0xCC)};
}

RunnerNode::RunnerNode(const NetworkNamespace& where, std::uint32_t member,
                       MeshSocketsConfig sockets)
    : running_(asio::make_work_guard(io_)) {
  runner_ = std::make_unique<MeshRunner>(io_, config_of(member, std::move(sockets)),
                                         std::make_shared<PresharedKeys>(kFleetKey), map_,
                                         [this](MeshEvent event) {
                                           const std::lock_guard lock(mutex_);
                                           events_.push_back(std::move(event));
                                           changed_.notify_all();
                                         });
  thread_ = std::thread([this, &where] {
    where.enter();
    runner_->start();
    io_.run();
  });
}

RunnerNode::~RunnerNode() {
  asio::post(io_, [this] {
    runner_->stop();
    running_.reset();
  });
  thread_.join();
}

bool RunnerNode::until(const std::function<bool(const std::vector<MeshEvent>&)>& condition) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] { return condition(events_); });
}

}  // namespace warren::mesh::test
