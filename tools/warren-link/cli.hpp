// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "tools/warren-link/options.hpp"

namespace warren {

struct ExitCommand {  // help was printed (0), or the line was wrong (2)
  int code = 0;
};

std::variant<LinkOptions, ExitCommand> parse_command_line(int argc, char** argv);

}  // namespace warren
