// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-link/namespaces.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/wait.h>

namespace warren {
namespace {

using Error = tl::unexpected<std::string>;

constexpr char kDevice[] = "radio0";

std::string name_of(pid_t owner, std::size_t number) {
  return "warren-" + std::to_string(owner) + "-" + std::to_string(number);
}

bool run(const std::string& command) { return std::system(command.c_str()) == 0; }

void kill_all_in(const std::string& name) {
  FILE* pids = popen(("ip netns pids " + name + " 2>/dev/null").c_str(), "r");
  if (pids == nullptr) return;
  for (int pid = 0; std::fscanf(pids, "%d", &pid) == 1;) kill(pid, SIGKILL);
  pclose(pids);
}

[[noreturn]] void watch(pid_t owner, int made) {
  setsid();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  // Whoever waits for the end of the emulator's output shall not wait for us.
  const int null = open("/dev/null", O_RDWR);
  for (int i = 0; i < 3; ++i) dup2(null, i);
  std::size_t count = 0;
  for (char byte = 0;;) {
    const ssize_t got = read(made, &byte, 1);
    if (got == 1) ++count;
    if (got == 0 || (got < 0 && errno != EINTR)) break;
  }
  for (std::size_t i = 0; i < count; ++i) {
    kill_all_in(name_of(owner, i));
    run("ip netns del " + name_of(owner, i));
  }
  _exit(0);
}

tl::expected<FileDescriptor, std::string> open_device(bool ethernet) {
  FileDescriptor device(open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC));
  ifreq request{};
  static_assert(sizeof(kDevice) <= sizeof(request.ifr_name));
  std::memcpy(request.ifr_name, kDevice, sizeof(kDevice));
  request.ifr_flags = static_cast<short>((ethernet ? IFF_TAP : IFF_TUN) | IFF_NO_PI);
  if (device.get() < 0 || ioctl(device.get(), TUNSETIFF, &request) != 0) {
    return Error("/dev/net/tun: " + std::string(std::strerror(errno)));
  }
  return device;
}

// Of the calling thread's namespace.
void set_sysctl(const std::string& name, int value) {
  std::ofstream("/proc/sys/net/" + name) << value;
}

void set_sysctls(const NodeConfig& node) {
  const std::string device = kDevice;
  set_sysctl("ipv6/conf/" + device + "/accept_dad", 0);  // 1-2 s without an address otherwise
  set_sysctl("ipv6/conf/" + device + "/router_solicitations", 0);
  if (!node.neighbour_retry_ms) return;
  for (const char* family : {"ipv4", "ipv6"}) {
    set_sysctl(std::string(family) + "/neigh/" + device + "/retrans_time_ms",
               *node.neighbour_retry_ms);
  }
}

tl::expected<FileDescriptor, std::string> enter_and_set_up(const std::string& name,
                                                           const NodeConfig& node) {
  const FileDescriptor space(open(("/run/netns/" + name).c_str(), O_RDONLY | O_CLOEXEC));
  if (space.get() < 0 || setns(space.get(), CLONE_NEWNET) != 0)
    return Error("cannot enter " + name);
  auto device = open_device(node.ethernet);
  if (!device) return device;
  set_sysctls(node);
  char mac[64] = "";
  if (node.ethernet) {
    std::snprintf(mac, sizeof(mac), "address 02:00:00:00:00:%02x",
                  static_cast<unsigned>(node.number + 1));
  }
  const bool up =
      run("ip link set lo up && ip link set " + std::string(kDevice) + " " + mac +
          " up && ip addr add " + ipv4_of(node.number) + "/24 broadcast + dev " + kDevice +
          " && ip -6 addr add " + ipv6_of(node.number) + "/64 nodad dev " + kDevice);
  if (!up) return Error("cannot set up " + std::string(kDevice) + " in " + name);
  return device;
}

}  // namespace

std::string ipv4_of(std::size_t number) { return "10.77.0." + std::to_string(number + 1); }

std::string ipv6_of(std::size_t number) {
  char text[32];
  std::snprintf(text, sizeof(text), "fd77::%zx", number + 1);
  return text;
}

Namespaces::Namespaces() : owner_(getpid()) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return;
  watcher_ = fork();
  if (watcher_ == 0) {
    close(ends[1]);
    watch(owner_, ends[0]);
  }
  close(ends[0]);
  made_ = FileDescriptor(ends[1]);
}

Namespaces::~Namespaces() {
  made_.close();
  if (watcher_ > 0) waitpid(watcher_, nullptr, 0);
}

std::string Namespaces::name(std::size_t number) const { return name_of(owner_, number); }

tl::expected<FileDescriptor, std::string> Namespaces::add(const NodeConfig& node) {
  if (watcher_ < 0) return Error("cannot start the watcher");
  if (!run("ip netns add " + name(node.number))) {
    return Error("cannot make the network namespace " + name(node.number) +
                 " (root and iproute2 are needed)");
  }
  const char byte = 0;
  if (write(made_.get(), &byte, 1) != 1) return Error("the watcher is gone");
  tl::expected<FileDescriptor, std::string> device = Error("");
  // A thread of its own enters, and ends there.
  std::thread([&] { device = enter_and_set_up(name(node.number), node); }).join();
  return device;
}

}  // namespace warren
