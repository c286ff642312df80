// SPDX-License-Identifier: Apache-2.0
// Real sockets on real (virtual) networks, in namespaces of their own.
#include "transport/udp/mesh_sockets.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <thread>

#include <doctest/doctest.h>

#include "tests/transport/udp/network_namespace.hpp"
#include "tests/transport/udp/socket_node.hpp"
#include "transport/udp/address_text.hpp"

using namespace warren;
using namespace warren::mesh;
using test::CabledNamespaces;
using test::NetworkNamespace;
using test::SocketNode;

namespace {

const MeshPath kGroup{0, true, {}};

MeshPath path(const std::string& address) { return {0, false, *parse_mesh_address(address)}; }

MeshSocketsConfig on(SocketInterface interface) { return {.interfaces = {std::move(interface)}}; }

MeshSocketsConfig ipv4_only() { return on({"radio0", true, false, false}); }

std::size_t times(const std::vector<SocketNode::Heard>& heard, const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(heard.begin(), heard.end(), [&](const auto& one) { return one.text == text; }));
}

}  // namespace

TEST_CASE("what goes to the group arrives, and the answer goes to where it came from") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  for (const bool ipv6 : {false, true}) {
    CAPTURE(ipv6);
    SocketNode ann(cable->first, on({"radio0", !ipv6, ipv6, false}));
    SocketNode bob(cable->second, on({"radio0", !ipv6, ipv6, false}));
    ann.send(kGroup, "who is there");
    const auto heard = bob.heard_until("who is there");
    REQUIRE(heard.size() == 1);
    CHECK(to_text(heard[0].from.address) == (ipv6 ? "[fe80::1]:7718" : "10.9.0.1:7718"));
    CHECK_FALSE(heard[0].from.group);
    bob.send(heard[0].from, "bob");
    CHECK(ann.heard_until("bob").size() == 1);  // and not the own word
  }
}

TEST_CASE("both families at once: two datagrams, two addresses") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  SocketNode ann(cable->first, on({"radio0", true, true, false}));
  SocketNode bob(cable->second, on({"radio0", true, true, false}));
  ann.send(kGroup, "hello");
  ann.send(path("10.9.0.2:7718"), "the end");
  bob.heard_until("the end");
  CHECK(times(bob.heard_until("the end"), "hello") == 2);
  CHECK(ann.counts().sent == 3);
}

TEST_CASE("a radio that passes no multicast is reached by directed broadcast") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  auto other_group = ipv4_only();
  other_group.group_ipv4[3] += 1;
  SocketNode bob(cable->second, other_group);
  SocketNode mute(cable->first, [] {
    auto config = ipv4_only();
    config.port = 7719;
    return config;
  }());
  SocketNode ann(cable->first, on({"radio0", true, false, true}));
  mute.send(kGroup, "to a group that bob has not joined");
  ann.send(kGroup, "hello");
  CHECK(bob.heard_until("hello").size() == 1);
}

TEST_CASE("seeds may name the group's port") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  SocketNode ann(cable->first, ipv4_only());
  SocketNode bob(cable->second, ipv4_only());
  ann.send(path("10.9.0.2:7717"), "seed");
  CHECK(bob.heard_until("seed").size() == 1);
}

TEST_CASE("several nodes share a host and a group, each with a port of its own") {
  const auto alone = NetworkNamespace::make();
  if (!alone) return;
  MeshSocketsConfig config{.interfaces = {{"lo", true, false, false}}};
  config.port = 0;
  config.group_loop = true;
  SocketNode ann(*alone, config);
  SocketNode bob(*alone, config);
  CHECK(ann.port() != bob.port());
  REQUIRE(ann.reaches_by_group(bob, "hello"));
  bob.send(path("127.0.0.1:" + std::to_string(ann.port())), "for ann alone");
  CHECK(times(ann.heard_until("for ann alone"), "for ann alone") == 1);
}

TEST_CASE("what is meant for an interface leaves through no other") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  const NetworkNamespace& first = cable->first;
  REQUIRE(first.ip("link add radio1 type veth peer name lonely"));
  REQUIRE(first.ip("link set radio1 up"));
  REQUIRE(first.ip("address add 10.8.0.1/24 dev radio1"));
  MeshSocketsConfig config{
      .interfaces = {{"radio1", true, false, false}, {"radio0", true, false, false}}};
  SocketNode ann(first, config);
  SocketNode bob(cable->second, ipv4_only());
  const MeshAddress bobs = *parse_mesh_address("10.9.0.2:7718");
  ann.send({0, true, {}}, "by the wrong one");
  ann.send({0, false, bobs}, "by the wrong one");
  ann.send({1, false, bobs}, "by the right one");
  CHECK(bob.heard_until("by the right one").size() == 1);
}

TEST_CASE("errors of sending are counted and survived") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  SocketNode ann(cable->first, on({"radio0", true, true, false}));
  SocketNode bob(cable->second, ipv4_only());
  const MeshPath to_bob = path("10.9.0.2:7718");
  ann.send(to_bob, std::string(1473, 'x'));  // 1501 bytes of IP: not in fragments
  CHECK(ann.counts().too_large == 1);
  ann.send(path("[2001:db8::1]:7718"), "no route");
  CHECK(ann.counts().unreachable == 1);
  bob.send(path("[fe80::1]:7718"), "a family that bob has not");
  CHECK(bob.counts().interface_down == 1);
  CHECK(ann.counts().sent == 0);
  ann.send(to_bob, std::string(1472, 'x'));
  ann.send(to_bob, "still here");
  CHECK(times(bob.heard_until("still here"), "still here") == 1);
  CHECK(ann.counts().sent == 2);
}

TEST_CASE("each error of sending has its count") {
  SocketCounts counts;
  for (const int error : {EMSGSIZE, ENETUNREACH, EHOSTUNREACH, ENETDOWN, ENODEV, EADDRNOTAVAIL,
                          EAGAIN, ENOBUFS, EPERM, EACCES, EINVAL}) {
    count_send_failure(counts, error);
  }
  CHECK(counts.too_large == 1);
  CHECK(counts.unreachable == 5);
  CHECK(counts.buffers_full == 2);
  CHECK(counts.not_permitted == 2);
  CHECK(counts.send_failed == 1);
}

TEST_CASE("a full link costs datagrams, not the node") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  // Over what the queue takes, the kernel drops and says so, or the socket's buffer is full.
  REQUIRE(std::system("which tc >/dev/null 2>&1") == 0);
  SocketNode ann(cable->first, ipv4_only());
  SocketNode bob(cable->second, ipv4_only());
  bool limited = false;
  std::thread([&] {
    cable->first.enter();
    limited =
        std::system("tc qdisc add dev radio0 root tbf rate 1mbit burst 2000 limit 3000000") == 0;
  }).join();
  REQUIRE(limited);
  for (int i = 0; i < 1000; ++i) ann.send(path("10.9.0.2:7718"), std::string(1400, 'x'));
  const SocketCounts counts = ann.counts();
  CHECK(counts.buffers_full > 0);
  CHECK(counts.buffers_full + counts.sent == 1000);
}

TEST_CASE("an interface that goes down and comes back is used again, its group joined again") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  const auto config = on({"radio0", true, true, false});
  SocketNode ann(cable->first, config);
  SocketNode bob(cable->second, config);
  REQUIRE(ann.reaches_by_group(bob, "before"));
  REQUIRE(cable->second.ip("link set radio0 down"));
  REQUIRE(bob.until([](const MeshSockets& sockets) { return !sockets.is_open(0); }));
  CHECK(bob.until([](const auto& sockets) { return sockets.problem(0) == "radio0 is down"; }));
  bob.send(kGroup, "nowhere");
  CHECK(bob.counts().interface_down == 1);
  REQUIRE(cable->second.ip("link set radio0 up"));
  CHECK(ann.reaches_by_group(bob, "after"));
  CHECK(bob.reaches_by_group(ann, "back"));
  CHECK(bob.port() == 7718);
  CHECK(bob.counts().open_failed == 0);
}

TEST_CASE("an interface that is made anew is found, one that comes late too") {
  auto cable = CabledNamespaces::make();
  if (!cable) return;
  SocketNode ann(cable->first, ipv4_only());
  SocketNode bob(cable->second, ipv4_only());
  REQUIRE(ann.reaches_by_group(bob, "before"));
  REQUIRE(cable->first.ip("link delete radio0"));
  REQUIRE(bob.until([](const MeshSockets& sockets) { return !sockets.is_open(0); }));
  CHECK(bob.until(
      [](const auto& sockets) { return sockets.problem(0) == "there is no interface radio0"; }));
  REQUIRE(cable->first.ip("link add radio0 type veth peer name other"));
  REQUIRE(cable->first.ip("link set other netns " + cable->second.path() + " name radio0"));
  REQUIRE(cable->first.ip("address add 10.7.0.1/24 dev radio0"));
  REQUIRE(cable->second.ip("address add 10.7.0.2/24 dev radio0"));
  REQUIRE(cable->first.ip("link set radio0 up"));
  REQUIRE(cable->second.ip("link set radio0 up"));
  CHECK(ann.reaches_by_group(bob, "after"));
  CHECK(to_text(bob.heard_until("after").back().from.address) == "10.7.0.1:7718");
}

TEST_CASE("a changed address is used at once") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  SocketNode ann(cable->first, on({"radio0", true, false, true}));
  SocketNode bob(cable->second, ipv4_only());
  REQUIRE(cable->first.ip("address del 10.9.0.1/24 dev radio0"));
  REQUIRE(ann.until([](const auto& sockets) { return sockets.counts(0).opened >= 2; }));
  ann.send(kGroup, "without an address");
  CHECK(ann.counts().interface_down == 1);
  REQUIRE(cable->first.ip("address add 10.9.0.77/24 broadcast 10.9.0.255 dev radio0"));
  REQUIRE(ann.reaches_by_group(bob, "with another"));
  CHECK(to_text(bob.heard_until("with another").back().from.address) == "10.9.0.77:7718");
}

TEST_CASE("a port that another process has is told, and taken when it is free") {
  const auto alone = NetworkNamespace::make();
  if (!alone) return;
  const auto config = on({"lo", true, false, false});
  auto first = std::make_unique<SocketNode>(*alone, config);
  SocketNode second(*alone, config);
  CHECK(second.until([](const auto& sockets) {
    return sockets.problem(0) == "lo: bind: Address already in use" && !sockets.is_open(0);
  }));
  first.reset();
  CHECK(second.until([](const auto& sockets) { return sockets.is_open(0); }));
}
