// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace warren {

// One command, running once in each of several network namespaces.
class NodeCommands {
 public:
  // Ends those that still run: asked first, killed after two seconds.
  ~NodeCommands();

  // Its environment has WARREN_NODE and WARREN_NODES.
  bool start(const std::string& network_namespace, const std::vector<std::string>& command,
             std::size_t node, std::size_t nodes);
  // After SIGCHLD.
  void collect();
  bool all_ended() const { return running_.empty(); }
  // Of the first that failed; 0 if none did.
  int exit_code() const { return exit_code_; }

 private:
  std::vector<pid_t> running_;  // each leads a process group
  int exit_code_ = 0;
};

}  // namespace warren
