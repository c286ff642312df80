// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-link/event_loop.hpp"

#include <array>
#include <cassert>
#include <csignal>

#include <sched.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

namespace warren {
namespace {

constexpr std::uint64_t kSignals = 1'000'000;  // larger than any node's number
constexpr std::uint64_t kTimer = kSignals + 1;
constexpr std::uint64_t kControl = kSignals + 2;

sigset_t loop_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGCHLD}) sigaddset(&set, signal);
  return set;
}

class Loop {
 public:
  Loop(Emulator& emulator, NodeCommands& commands, const LoopConfig& config)
      : emulator_(emulator),
        commands_(commands),
        config_(config),
        epoll_(epoll_create1(EPOLL_CLOEXEC)) {
    const sigset_t set = loop_signals();
    signals_ = FileDescriptor(signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC));
    timer_ = FileDescriptor(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
    watch(signals_.get(), kSignals);
    watch(timer_.get(), kTimer);
    if (config.control) watch(STDIN_FILENO, kControl);
    for (std::size_t node = 0; node < emulator.model().stations(); ++node) {
      watch(emulator.device(node), node);
    }
  }

  void run() {
    while (!ended()) {
      arm(emulator_.deliver());
      std::array<epoll_event, 64> events;
      const int count =
          epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()), -1);
      for (int i = 0; i < count; ++i) take(events[static_cast<std::size_t>(i)].data.u64);
    }
  }

 private:
  void watch(int descriptor, std::uint64_t what) {
    epoll_event event{.events = EPOLLIN, .data = {.u64 = what}};
    // A regular file as standard input cannot be watched; there is nothing to wait for then.
    if (epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, descriptor, &event) != 0) assert(what == kControl);
  }

  bool ended() const {
    if (told_to_end_ || (config_.end && monotonic_now() >= *config_.end)) return true;
    return config_.ends_with_commands && commands_.all_ended();
  }

  void arm(MeshTime next) {
    if (config_.end) next = std::min(next, *config_.end);
    itimerspec spec{};
    if (next != kNever) {
      // A time that has passed fires at once; zero would switch the timer off.
      const auto us = std::max<std::int64_t>(1, next.time_since_epoch().count());
      spec.it_value = {us / 1'000'000, us % 1'000'000 * 1000};
    }
    timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &spec, nullptr);
  }

  void take(std::uint64_t what) {
    if (what < kSignals) {
      emulator_.take_from(what);
    } else if (what == kSignals) {
      take_signals();
    } else if (what == kControl) {
      take_control();
    } else {
      std::uint64_t expirations = 0;
      (void)!read(timer_.get(), &expirations, sizeof(expirations));
    }
  }

  void take_signals() {
    signalfd_siginfo info;
    while (read(signals_.get(), &info, sizeof(info)) == sizeof(info)) {
      if (info.ssi_signo == SIGCHLD) {
        commands_.collect();
      } else {
        told_to_end_ = true;
      }
    }
  }

  void take_control() {
    std::array<char, 256> bytes;
    const ssize_t got = read(STDIN_FILENO, bytes.data(), bytes.size());
    if (got <= 0) told_to_end_ = true;
    for (ssize_t i = 0; i < got; ++i) {
      const char byte = bytes[static_cast<std::size_t>(i)];
      if (byte != '\n') {
        if (line_.size() < bytes.size()) line_ += byte;
        continue;
      }
      obey(line_);
      line_.clear();
    }
  }

  void obey(const std::string& line) {
    if (line == "off" || line == "on") emulator_.set_silent(line == "off");
    if (line == "stats") config_.print_stats();
    if (line == "quit") told_to_end_ = true;
  }

  Emulator& emulator_;
  NodeCommands& commands_;
  const LoopConfig& config_;
  FileDescriptor epoll_;
  FileDescriptor signals_;
  FileDescriptor timer_;
  std::string line_;
  bool told_to_end_ = false;
};

}  // namespace

void run_loop(Emulator& emulator, NodeCommands& commands, const LoopConfig& config) {
  Loop(emulator, commands, config).run();
}

void prepare_process() {
  const sigset_t set = loop_signals();
  sigprocmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  const sched_param first{.sched_priority = 1};
  // Children are not to be so urgent.
  sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &first);
}

}  // namespace warren
