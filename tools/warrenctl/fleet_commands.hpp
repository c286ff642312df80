// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

namespace warren {

struct MessageSendCommand {
  std::string to;  // a node's name; empty: everybody
  bool urgent = false;
  std::string key;
  std::string text;
  std::filesystem::path file;  // in place of the text
};
struct MessageWatchCommand {
  bool json = false;  // an object per line
  int seconds = 0;    // how long to wait for more
};
struct FleetOrderCommand {
  enum class What : std::uint8_t { kRetract, kRestore, kClear, kAlign };
  What what = What::kRetract;
  std::string subject;  // a node's name; but to clear also a layer
  std::array<double, 3> shift_fleet_m{};
  double yaw_deg = 0.0;
};
struct AlignEstimateCommand {
  std::string node;
  std::string against;
  bool json = false;
};
struct TrajectoryCommand {
  std::string node;
  bool json = false;
};
using FleetCommand = std::variant<MessageSendCommand, MessageWatchCommand, FleetOrderCommand,
                                  AlignEstimateCommand, TrajectoryCommand>;

// Talks to the daemon behind this socket; the exit code.
int run(const FleetCommand& command, const std::string& socket);

}  // namespace warren
