// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include <doctest/doctest.h>
#include <unistd.h>

#include "tests/tools/link/running_link.hpp"

using namespace warren;
using namespace warren::test;
using namespace std::chrono_literals;

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint16_t kPort = 7777;
constexpr std::size_t kUdpIpHeader = 28;

double milliseconds(Clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

// The packets of the test, without what the kernel sends by itself.
std::size_t receive_all(const FileDescriptor& socket) {
  std::size_t count = 0;
  while (receive(socket)) ++count;
  return count;
}

bool becomes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 500; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return condition();
}

bool is_running(pid_t pid) { return kill(pid, 0) == 0; }

}  // namespace

// Timed on purpose: precise time is what the emulator is for. The median tolerates a busy machine.
TEST_CASE("a round trip takes twice the delay, to 2 ms") {
  if (!may_make_namespaces()) return;
  RunningLink link({"--tun", "--delay-ms", "50"});
  const auto here = udp_socket_in(link.name(0), kPort, 2s);
  const auto there = udp_socket_in(link.name(1), kPort, 2s);
  std::vector<double> rtts_ms;
  for (int i = 0; i < 21; ++i) {
    const auto sent = Clock::now();
    send_to(here, "10.77.0.2", kPort, "ping");
    REQUIRE(receive(there) == "ping");
    send_to(there, "10.77.0.1", kPort, "pong");
    REQUIRE(receive(here) == "pong");
    rtts_ms.push_back(milliseconds(Clock::now() - sent));
  }
  std::sort(rtts_ms.begin(), rtts_ms.end());
  CHECK(rtts_ms.front() >= 100.0);
  CHECK(rtts_ms[10] <= 102.0);
}

TEST_CASE("a burst passes at the link's rate, and what the queue does not take is dropped") {
  if (!may_make_namespaces()) return;
  RunningLink link({"--tun", "--rate", "1e6", "--queue-packets", "60"});
  const auto here = udp_socket_in(link.name(0), kPort, 2s);
  const auto there = udp_socket_in(link.name(1), kPort, 1s);
  for (int i = 0; i < 100; ++i) {
    send_to(here, "10.77.0.2", kPort, std::string(1250 - kUdpIpHeader, 'x'));
  }
  REQUIRE(receive(there));
  const auto first = Clock::now();
  auto last = first;
  std::size_t count = 1;
  while (receive(there)) {
    ++count;
    last = Clock::now();
  }
  CHECK(count >= 60);
  CHECK(count <= 64);  // one on the air, some sent while the first ones left
  CHECK(milliseconds(last - first) / static_cast<double>(count - 1) ==
        doctest::Approx(10.0).epsilon(0.02));
}

TEST_CASE("losses have their share, and the counts tell of every packet") {
  if (!may_make_namespaces()) return;
  RunningLink link({"--tun", "--loss", "0.2", "--link", "1,0,loss=0,delay-ms=1"});
  const auto here = udp_socket_in(link.name(0), kPort, 300ms);
  const auto there = udp_socket_in(link.name(1), kPort, 300ms);
  for (int i = 0; i < 2000; ++i) {
    send_to(here, "10.77.0.2", kPort, std::string(100, 'x'));
    send_to(there, "10.77.0.1", kPort, std::string(100, 'x'));
    if (i % 20 == 0) std::this_thread::sleep_for(1ms);
  }
  const auto arrived = receive_all(there);
  CHECK(arrived == doctest::Approx(1600).epsilon(0.045));  // 4 deviations
  CHECK(receive_all(here) == 2000);
  link.send_signal(SIGTERM);
  CHECK(link.wait() == 0);
  const auto& there_counts = link.stats()["links"][0];
  CHECK(there_counts["offered_packets"] >= 2000);
  CHECK(there_counts["offered_packets"].get<int>() ==
        there_counts["delivered_packets"].get<int>() + there_counts["dropped"]["loss"].get<int>());
}

TEST_CASE("on the switch unicast, broadcast and multicast arrive, IPv4 and IPv6") {
  if (!may_make_namespaces()) return;
  RunningLink link({"--tap", "--nodes", "5", "--rate", "1e6", "--shared-airtime"});
  std::vector<FileDescriptor> sockets;
  std::vector<FileDescriptor> sockets6;
  for (std::size_t node = 0; node < 5; ++node) {
    sockets.push_back(udp_socket_in(link.name(node), kPort, 1s));
    sockets6.push_back(udp_socket_in(link.name(node), kPort + 1, 1s, AF_INET6));
  }
  for (const char* group : {"10.77.0.255", "239.77.0.1"}) {
    send_to(sockets[0], group, kPort, group);
    for (std::size_t node = 1; node < 5; ++node) CHECK(receive(sockets[node]) == group);
  }
  send_to(sockets[0], "10.77.0.4", kPort, "to you");
  CHECK(receive(sockets[3]) == "to you");
  send_to(sockets6[4], "fd77::2", kPort + 1, "to you by IPv6");
  CHECK(receive(sockets6[1]) == "to you by IPv6");
  link.send_signal(SIGTERM);
  link.wait();
  // Answers to ARP are unicast: the switch had learnt where to.
  for (const auto& one : link.stats()["nodes"]) CHECK(one["write_errors"] == 0);
}

TEST_CASE("in a blackout nothing arrives, scheduled or switched") {
  if (!may_make_namespaces()) return;
  RunningLink link({"--tun", "--control", "--blackout", "0.0", "0.4"});
  const auto here = udp_socket_in(link.name(0), kPort, 100ms);
  const auto there = udp_socket_in(link.name(1), kPort, 100ms);
  send_to(here, "10.77.0.2", kPort, "too early");
  CHECK(!receive(there));
  std::this_thread::sleep_for(400ms);
  send_to(here, "10.77.0.2", kPort, "heard");
  CHECK(receive(there) == "heard");
  link.command("off");
  std::this_thread::sleep_for(50ms);
  send_to(here, "10.77.0.2", kPort, "lost");
  CHECK(!receive(there));
  link.command("on");
  std::this_thread::sleep_for(50ms);
  send_to(here, "10.77.0.2", kPort, "heard again");
  CHECK(receive(there) == "heard again");
  link.command("quit");
  CHECK(link.wait() == 0);
  CHECK(link.stats()["links"][0]["dropped"]["blackout"] >= 2);
}

TEST_CASE("commands run in every node, and the first failure is the result") {
  if (!may_make_namespaces()) return;
  RunningLink link({"--tap", "--nodes", "3", "--", "sh", "-c",
                    "test -e /sys/class/net/radio0 && exit $((WARREN_NODE / 2 * 7))"});
  const std::string name = link.name(0);
  CHECK(link.wait() == 7);
  CHECK(!namespace_exists(name));
}

TEST_CASE("nothing stays behind after SIGTERM, nor after SIGKILL") {
  if (!may_make_namespaces()) return;
  for (const int signal : {SIGTERM, SIGKILL}) {
    const std::string file = "/tmp/warren-link-test-" + std::to_string(getpid());
    // A command that does not listen to SIGTERM.
    RunningLink link(
        {"--tun", "--", "sh", "-c", "trap '' TERM; echo $$ >> " + file + "; sleep 600"});
    std::vector<pid_t> pids;
    CHECK(becomes_true([&] {
      pids.clear();
      std::ifstream in(file);
      for (pid_t pid = 0; in >> pid;) pids.push_back(pid);
      return pids.size() == 2;
    }));
    const std::string names[] = {link.name(0), link.name(1)};
    link.send_signal(signal);
    link.wait();
    CHECK(becomes_true([&] { return !namespace_exists(names[0]) && !namespace_exists(names[1]); }));
    for (const pid_t pid : pids) CHECK(becomes_true([&] { return !is_running(pid); }));
    std::remove(file.c_str());
  }
}
