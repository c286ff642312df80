// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tools/warren-bench/integrate.hpp"

namespace warren {

struct IntegrateArguments {
  SequenceSource source;
  IntegrateOptions options;
  std::optional<double> max_range_m;
  bool json = false;
};

// The benchmark asked for; none when help was printed (exit code 0) or the line was wrong (2).
struct CommandLine {
  std::optional<IntegrateArguments> integrate;
  int exit_code = 0;
};

CommandLine parse_command_line(int argc, char** argv);

}  // namespace warren
