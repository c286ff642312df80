// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/exchange/pose_file.hpp"
#include "tools/warren-replay/replay.hpp"

namespace warren {

struct ReplayArguments {
  std::string clouds;
  std::optional<std::string> poses;
  PoseFormat poses_format = PoseFormat::kKitti;
  Eigen::Vector3d gravity_map{0.0, 0.0, -1.0};
  std::string socket;
  ReplayOptions options;
  bool json = false;
};

// The arguments; or the exit code when help was printed (0) or the line was wrong (2).
struct ReplayCommandLine {
  std::optional<ReplayArguments> arguments;
  int exit_code = 0;
};

ReplayCommandLine parse_command_line(int argc, char** argv);

}  // namespace warren
