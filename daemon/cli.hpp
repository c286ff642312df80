// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <variant>

namespace warren {

struct RunCommand {
  std::filesystem::path config;
};
struct CheckCommand {
  std::filesystem::path config;
};
struct PrintConfigCommand {
  std::filesystem::path config;  // empty: the defaults
};
struct PrintSampleCommand {
  bool of_base = false;
};
struct ExitCommand {  // all is said: help, version, or wrong usage
  int code = 0;
};
using WarrendCommand =
    std::variant<RunCommand, CheckCommand, PrintConfigCommand, PrintSampleCommand, ExitCommand>;

WarrendCommand parse_command_line(int argc, char** argv);

}  // namespace warren
