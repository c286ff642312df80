// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "tools/warren-sim/live.hpp"
#include "tools/warren-sim/scenario.hpp"
#include "tools/world/truth/write_truth.hpp"

namespace warren::world {

struct RecordCommand {
  ScenarioOptions scenario;
  std::string out;
  TruthOptions truth;
};
struct RunCommand {
  ScenarioOptions scenario;
  LiveOptions live;
  bool json = false;
};
struct RenderCommand {
  ScenarioOptions scenario;
  std::string out;
};
struct RadioCommand {
  ScenarioOptions scenario;
  std::string out;
  double step_s = 1.0;
};
struct WorldsCommand {};
struct ExitCommand {  // help was printed (0), or the line was wrong (2)
  int code = 0;
};

using Command = std::variant<RecordCommand, RunCommand, RenderCommand, RadioCommand, WorldsCommand,
                             ExitCommand>;
Command parse_command_line(int argc, char** argv);

}  // namespace warren::world
