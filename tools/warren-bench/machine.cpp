// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/machine.hpp"

#include <fstream>

namespace warren {
namespace {

std::string cpu_name() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    const auto colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

constexpr const char* instruction_set() {
#if defined(__AVX512F__)
  return "x86-64 with AVX-512";
#elif defined(__AVX2__)
  return "x86-64 with AVX2";
#elif defined(__x86_64__)
  return "baseline x86-64 (SSE2)";
#elif defined(__aarch64__)
  return "baseline aarch64";
#else
  return "unknown";
#endif
}

}  // namespace

Machine this_machine() {
  return {cpu_name(), std::string("g++ ") + __VERSION__ + " " + WARREN_BUILD_FLAGS,
          instruction_set()};
}

}  // namespace warren
