// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "tools/warren-bench/cli.hpp"
#include "tools/warren-bench/integrate.hpp"

namespace {

int run_integrate(const warren::IntegrateArguments& arguments) {
  const auto sequence = warren::load_sequence(arguments.source, arguments.options.map.resolution_m,
                                              arguments.max_range_m);
  if (!sequence) {
    std::fprintf(stderr, "warren-bench: %s\n", sequence.error().c_str());
    return 2;
  }
  const auto result = warren::bench_integrate(*sequence, arguments.options);
  const std::string text = arguments.json
                               ? to_json(result, arguments.options, arguments.max_range_m) + "\n"
                               : to_text(result);
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const warren::CommandLine line = warren::parse_command_line(argc, argv);
  if (!line.integrate) return line.exit_code;
  return run_integrate(*line.integrate);
}
