// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-link/node_commands.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>

#include <sys/wait.h>
#include <unistd.h>

#include "tools/link/argument_pointers.hpp"

namespace warren {
namespace {

constexpr int kPatienceMs = 2000;
constexpr int kCannotRun = 127;

[[noreturn]] void become(const std::string& network_namespace,
                         const std::vector<std::string>& command) {
  setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::vector<std::string> words{"ip", "netns", "exec", network_namespace};
  words.insert(words.end(), command.begin(), command.end());
  execvp("ip", argument_pointers(words).data());
  _exit(kCannotRun);
}

}  // namespace

NodeCommands::~NodeCommands() {
  for (const pid_t pid : running_) kill(-pid, SIGTERM);
  for (int waited = 0; waited < kPatienceMs && !running_.empty(); waited += 10) {
    collect();
    const timespec pause{0, 10'000'000};
    nanosleep(&pause, nullptr);
  }
  for (const pid_t pid : running_) kill(-pid, SIGKILL);
}

bool NodeCommands::start(const std::string& network_namespace,
                         const std::vector<std::string>& command, std::size_t node,
                         std::size_t nodes) {
  const pid_t pid = fork();
  if (pid < 0) return false;
  if (pid == 0) {
    setenv("WARREN_NODE", std::to_string(node).c_str(), 1);
    setenv("WARREN_NODES", std::to_string(nodes).c_str(), 1);
    become(network_namespace, command);
  }
  running_.push_back(pid);
  return true;
}

void NodeCommands::collect() {
  std::erase_if(running_, [this](pid_t pid) {
    int status = 0;
    if (waitpid(pid, &status, WNOHANG) != pid) return false;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (exit_code_ == 0) exit_code_ = code;
    return true;
  });
}

}  // namespace warren
