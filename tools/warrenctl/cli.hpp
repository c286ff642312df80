// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <variant>

namespace warren {

struct StatusCommand {
  bool json = false;
};
struct MapInfoCommand {
  bool json = false;
};
struct MapSaveCommand {
  std::filesystem::path file;
};
struct ConfigCheckCommand {
  std::filesystem::path file;
};
struct ConfigPrintCommand {
  std::filesystem::path file;  // empty: what the daemon runs with
};
struct ExitCommand {  // all is said: help, version, or wrong usage
  int code = 0;
};
using CtlCommand = std::variant<StatusCommand, MapInfoCommand, MapSaveCommand, ConfigCheckCommand,
                                ConfigPrintCommand, ExitCommand>;

struct CtlArguments {
  std::string socket;
  CtlCommand command;
};

CtlArguments parse_command_line(int argc, char** argv);

}  // namespace warren
