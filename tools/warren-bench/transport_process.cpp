// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/transport_process.hpp"

#include <algorithm>
#include <array>
#include <csignal>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/link/argument_pointers.hpp"

namespace warren {

ChildProcess::ChildProcess(const std::vector<std::string>& words) {
  std::signal(SIGPIPE, SIG_IGN);
  int in[2];
  int out[2];
  if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0) {
    ended_ = true;
    return;
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  std::vector<std::string> copies = words;
  const std::vector<char*> arguments = argument_pointers(copies);
  if (posix_spawnp(&pid_, arguments[0], &actions, nullptr, arguments.data(), environ) != 0) {
    pid_ = -1;
    ended_ = true;
  }
  posix_spawn_file_actions_destroy(&actions);
  close(in[0]);
  close(out[1]);
  input_ = in[1];
  output_ = out[0];
}

ChildProcess::~ChildProcess() {
  kill();
  close(input_);
  close(output_);
}

std::optional<std::string> ChildProcess::read_line(std::chrono::steady_clock::time_point until) {
  for (;;) {
    const std::size_t end = unread_.find('\n');
    if (end != std::string::npos) {
      const std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      return line;
    }
    if (ended_) return {};
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    pollfd waiting{output_, POLLIN, 0};
    if (poll(&waiting, 1, std::max(0, static_cast<int>(left.count()))) <= 0) return {};
    std::array<char, 65536> bytes;
    const ssize_t got = read(output_, bytes.data(), bytes.size());
    if (got <= 0) {
      ended_ = true;
    } else {
      unread_.append(bytes.data(), static_cast<std::size_t>(got));
    }
  }
}

void ChildProcess::write_line(const std::string& line) {
  const std::string text = line + "\n";
  (void)!write(input_, text.data(), text.size());
}

std::chrono::microseconds ChildProcess::wait() {
  rusage used{};
  if (pid_ > 0) wait4(pid_, nullptr, 0, &used);
  pid_ = -1;
  const auto time = [](const timeval& value) {
    return std::chrono::seconds(value.tv_sec) + std::chrono::microseconds(value.tv_usec);
  };
  return time(used.ru_utime) + time(used.ru_stime);
}

std::chrono::microseconds ChildProcess::kill() {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
  return wait();
}

}  // namespace warren
