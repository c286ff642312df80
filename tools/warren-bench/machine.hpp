// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace warren {

// What a figure was measured on.
struct Machine {
  std::string cpu;        // as /proc/cpuinfo names it
  std::string build;      // compiler and flags
  std::string cpu_level;  // instruction set that the build uses
};

Machine this_machine();

}  // namespace warren
