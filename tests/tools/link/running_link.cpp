// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/link/running_link.hpp"

#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <net/if.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/link/argument_pointers.hpp"

namespace warren::test {

bool may_make_namespaces() {
  if (geteuid() == 0 && std::filesystem::exists("/dev/net/tun")) return true;
  MESSAGE("SKIPPED: network namespaces need root and /dev/net/tun");
  return false;
}

RunningLink::RunningLink(const std::vector<std::string>& arguments) {
  int in[2];
  int out[2];
  REQUIRE(pipe2(in, O_CLOEXEC) == 0);
  REQUIRE(pipe2(out, O_CLOEXEC) == 0);
  std::vector<std::string> words{WARREN_LINK};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const std::vector<char*> pointers = argument_pointers(words);
  pid_ = fork();
  if (pid_ == 0) {
    dup2(in[0], STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    execv(WARREN_LINK, pointers.data());
    _exit(127);
  }
  close(in[0]);
  close(out[1]);
  input_ = FileDescriptor(in[1]);
  output_ = FileDescriptor(out[0]);
  while (const auto line = read_line()) {
    if (*line == "ready") return;
  }
}

RunningLink::~RunningLink() {
  if (pid_ < 0) return;
  send_signal(SIGTERM);
  wait();
}

std::string RunningLink::name(std::size_t node) const {
  return "warren-" + std::to_string(pid_) + "-" + std::to_string(node);
}

void RunningLink::command(const std::string& line) {
  const std::string text = line + "\n";
  REQUIRE(write(input_.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()));
}

void RunningLink::send_signal(int signal) const { kill(pid_, signal); }

int RunningLink::wait() {
  while (const auto line = read_line()) {
    if (line->starts_with("{")) stats_ = nlohmann::json::parse(*line);
  }
  int status = 0;
  waitpid(std::exchange(pid_, -1), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::optional<std::string> RunningLink::read_line() {
  for (;;) {
    const std::size_t end = unread_.find('\n');
    if (end != std::string::npos) {
      const std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      return line;
    }
    char bytes[4096];
    const ssize_t got = read(output_.get(), bytes, sizeof(bytes));
    if (got <= 0) return {};
    unread_.append(bytes, static_cast<std::size_t>(got));
  }
}

FileDescriptor udp_socket_in(const std::string& network_namespace, std::uint16_t port,
                             std::chrono::milliseconds patience, int family) {
  int socket = -1;
  // A thread's namespace is its own; the socket stays in it.
  std::thread([&] {
    const FileDescriptor space(open(("/run/netns/" + network_namespace).c_str(), O_RDONLY));
    if (setns(space.get(), CLONE_NEWNET) != 0) return;
    socket = ::socket(family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in v4{};
    v4.sin_family = AF_INET;
    v4.sin_port = htons(port);
    sockaddr_in6 v6{};
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(port);
    if (family == AF_INET) {
      (void)bind(socket, reinterpret_cast<const sockaddr*>(&v4), sizeof(v4));
      ip_mreqn group{};
      group.imr_multiaddr.s_addr = inet_addr("239.77.0.1");
      group.imr_ifindex = static_cast<int>(if_nametoindex("radio0"));
      setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof(group));
      setsockopt(socket, IPPROTO_IP, IP_MULTICAST_IF, &group, sizeof(group));
      const int off = 0;
      setsockopt(socket, IPPROTO_IP, IP_MULTICAST_LOOP, &off, sizeof(off));
    } else {
      (void)bind(socket, reinterpret_cast<const sockaddr*>(&v6), sizeof(v6));
    }
  }).join();
  REQUIRE(socket >= 0);
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_BROADCAST, &on, sizeof(on));
  const int large = 8'000'000;
  setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &large, sizeof(large));
  const timeval time{patience.count() / 1000, patience.count() % 1000 * 1000};
  setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof(time));
  return FileDescriptor(socket);
}

void send_to(const FileDescriptor& socket, const std::string& address, std::uint16_t port,
             const std::string& text) {
  sockaddr_in v4{};
  sockaddr_in6 v6{};
  v4.sin_family = AF_INET;
  v6.sin6_family = AF_INET6;
  v4.sin_port = v6.sin6_port = htons(port);
  const bool is_v4 = inet_pton(AF_INET, address.c_str(), &v4.sin_addr) == 1;
  if (!is_v4) inet_pton(AF_INET6, address.c_str(), &v6.sin6_addr);
  const auto* to =
      is_v4 ? reinterpret_cast<const sockaddr*>(&v4) : reinterpret_cast<sockaddr*>(&v6);
  CHECK(sendto(socket.get(), text.data(), text.size(), 0, to, is_v4 ? sizeof(v4) : sizeof(v6)) ==
        static_cast<ssize_t>(text.size()));
}

std::optional<std::string> receive(const FileDescriptor& socket) {
  char bytes[2048];
  const ssize_t got = recv(socket.get(), bytes, sizeof(bytes), 0);
  if (got < 0) return {};
  return std::string(bytes, static_cast<std::size_t>(got));
}

bool namespace_exists(const std::string& name) {
  return std::filesystem::exists("/run/netns/" + name);
}

}  // namespace warren::test
