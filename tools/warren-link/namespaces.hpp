// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>
#include <tl/expected.hpp>

#include "tools/warren-link/file_descriptor.hpp"

namespace warren {

struct NodeConfig {
  std::size_t number = 0;
  bool ethernet = false;
  std::optional<int> neighbour_retry_ms;
};

// Network namespaces warren-PID-NUMBER that this process made, and no others. A second process
// watches: when this one is gone, however it ended, it kills what still runs in them and removes
// them.
class Namespaces {
 public:
  Namespaces();
  ~Namespaces();
  Namespaces(const Namespaces&) = delete;
  Namespaces& operator=(const Namespaces&) = delete;

  // Makes one with the interface radio0, up, 10.77.0.(number + 1)/24 and fd77::(number + 1)/64.
  // Returns the emulator's end of it, which does not block.
  tl::expected<FileDescriptor, std::string> add(const NodeConfig& node);

  std::string name(std::size_t number) const;

 private:
  pid_t owner_;
  pid_t watcher_ = -1;
  FileDescriptor made_;  // a byte for each namespace; its end tells the watcher to clean up
};

std::string ipv4_of(std::size_t number);
std::string ipv6_of(std::size_t number);

}  // namespace warren
