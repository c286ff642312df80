// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli.hpp"

#include <string>

#include <CLI/CLI.hpp>

namespace warren {
namespace {

constexpr int kUsageError = 2;

}  // namespace

WarrendCommand parse_command_line(int argc, char** argv) {
  CLI::App app("Builds a 3-D occupancy map from the scans that come through its ingest socket.");
  std::string config = "/etc/warren/robot.yaml";
  std::string checked;
  std::string printed;
  app.add_option("-c,--config", config, "Configuration file")->capture_default_str();
  auto* const check =
      app.add_option("--check", checked, "Check a configuration file, tell all faults, exit");
  auto* const print = app.add_option("--print-config", printed,
                                     "Print the configuration in FILE, or the defaults, with "
                                     "every key; exit")
                          ->expected(0, 1);
  std::string role = "robot";
  auto* const sample =
      app.add_option("--print-sample", role,
                     "Print the defaults of a robot or a base with a comment for every key; exit")
          ->expected(0, 1)
          ->check(CLI::IsMember({"robot", "base"}));
  app.set_version_flag("--version", std::string("warrend ") + WARREN_VERSION);
  check->excludes(print)->excludes(sample);
  print->excludes(sample);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return ExitCommand{app.exit(error) == 0 ? 0 : kUsageError};
  }
  if (check->count() > 0) return CheckCommand{checked};
  if (print->count() > 0) return PrintConfigCommand{printed};
  if (sample->count() > 0) return PrintSampleCommand{role == "base"};
  return RunCommand{config};
}

}  // namespace warren
