// SPDX-License-Identifier: Apache-2.0
#include "tests/transport/udp/network_namespace.hpp"

#include <cassert>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <utility>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include "transport/udp/link_state.hpp"

namespace warren::mesh::test {
namespace {

constexpr const char* kOwn = "/proc/thread-self/ns/net";

// The kernel settles carriers a little later.
bool wait_until_running(const NetworkNamespace& where) {
  bool running = false;
  std::thread([&] {
    where.enter();
    for (int i = 0; i < 500 && !running; ++i) {
      running = read_link_state("radio0").value_or(LinkState{}).running;
      if (!running) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }).join();
  return running;
}

}  // namespace

std::optional<NetworkNamespace> NetworkNamespace::make() {
  int descriptor = -1;
  std::thread([&] {
    if (unshare(CLONE_NEWNET) == 0) descriptor = open(kOwn, O_RDONLY | O_CLOEXEC);
  }).join();
  if (descriptor < 0) {
    MESSAGE("SKIPPED: may not make a network namespace (needs root)");
    return std::nullopt;
  }
  NetworkNamespace made(descriptor);
  if (!made.ip("link set lo up")) {
    MESSAGE("SKIPPED: there is no iproute2");
    return std::nullopt;
  }
  return made;
}

NetworkNamespace::~NetworkNamespace() {
  if (descriptor_ >= 0) close(descriptor_);
}

NetworkNamespace::NetworkNamespace(NetworkNamespace&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

void NetworkNamespace::enter() const {
  [[maybe_unused]] const int failed = setns(descriptor_, CLONE_NEWNET);
  assert(failed == 0);
}

bool NetworkNamespace::ip(const std::string& arguments) const {
  bool succeeded = false;
  std::thread([&] {
    enter();
    succeeded = std::system(("ip " + arguments).c_str()) == 0;
  }).join();
  return succeeded;
}

std::string NetworkNamespace::path() const {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(descriptor_);
}

std::optional<CabledNamespaces> CabledNamespaces::make() {
  auto first = NetworkNamespace::make();
  if (!first) return std::nullopt;
  auto second = NetworkNamespace::make();
  if (!second) return std::nullopt;
  REQUIRE(first->ip("link add radio0 type veth peer name other"));
  REQUIRE(first->ip("link set other netns " + second->path() + " name radio0"));
  int last_byte = 1;
  for (const auto* side : {&*first, &*second}) {
    const std::string address = "10.9.0." + std::to_string(last_byte++) + "/24";
    REQUIRE(side->ip("link set radio0 addrgenmode none up"));
    REQUIRE(side->ip("address add " + address + " broadcast 10.9.0.255 dev radio0"));
    REQUIRE(side->ip("address add fe80::" + address.substr(7, 1) + "/64 dev radio0 nodad"));
  }
  REQUIRE(wait_until_running(*first));
  REQUIRE(wait_until_running(*second));
  return CabledNamespaces{std::move(*first), std::move(*second)};
}

}  // namespace warren::mesh::test
