// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/types.h>

#include "tools/warren-link/file_descriptor.hpp"

namespace warren::test {

// May this process make network namespaces? If not it says "SKIPPED:".
bool may_make_namespaces();

// A warren-link as a process of its own.
class RunningLink {
 public:
  // Returns when the nodes are there.
  explicit RunningLink(const std::vector<std::string>& arguments);
  ~RunningLink();

  pid_t pid() const { return pid_; }
  std::string name(std::size_t node) const;
  void command(const std::string& line);  // with --control
  void send_signal(int signal) const;
  // Waits for its end; the exit code (128 + the signal), and the counts if it printed any.
  int wait();
  const nlohmann::json& stats() const { return stats_; }

 private:
  std::optional<std::string> read_line();

  pid_t pid_ = -1;
  FileDescriptor input_;
  FileDescriptor output_;
  std::string unread_;
  nlohmann::json stats_;
};

// A bound UDP socket in a network namespace; it gives up receiving after `patience`.
FileDescriptor udp_socket_in(const std::string& network_namespace, std::uint16_t port,
                             std::chrono::milliseconds patience, int family = AF_INET);
void send_to(const FileDescriptor& socket, const std::string& address, std::uint16_t port,
             const std::string& text);
std::optional<std::string> receive(const FileDescriptor& socket);
bool namespace_exists(const std::string& name);

}  // namespace warren::test
