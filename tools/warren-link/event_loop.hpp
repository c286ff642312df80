// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "tools/warren-link/emulator.hpp"
#include "tools/warren-link/node_commands.hpp"

namespace warren {

struct LoopConfig {
  std::optional<MeshTime> end;
  bool ends_with_commands = false;
  bool control = false;               // lines from standard input
  std::function<void()> print_stats;  // for the line "stats"
};

// Runs the emulator until it is told to end: by SIGTERM, SIGINT or SIGHUP, by time, by the last
// command's end, or by the control line "quit" (or the end of input). Those signals and SIGCHLD
// must be blocked already.
void run_loop(Emulator& emulator, NodeCommands& commands, const LoopConfig& config);

// Blocks the signals that run_loop() takes, and asks for precise timing where that is allowed.
void prepare_process();

}  // namespace warren
