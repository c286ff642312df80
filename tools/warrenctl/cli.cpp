// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/cli.hpp"

#include <CLI/CLI.hpp>

namespace warren {
namespace {

constexpr int kUsageError = 2;

struct Options {
  std::string socket = "/run/warren/control.sock";
  bool json = false;
  std::string file;
};

CLI::App* add_with_json(CLI::App& app, const char* name, const char* text, Options& options) {
  auto* const command = app.add_subcommand(name, text);
  command->add_flag("--json", options.json, "One JSON object instead of a table");
  return command;
}

CtlCommand parse(CLI::App& app, Options& options, int argc, char** argv) {
  auto* const status = add_with_json(app, "status", "What the daemon takes and drops", options);
  auto* const map = app.add_subcommand("map", "The map of this robot")->require_subcommand(1);
  auto* const info = add_with_json(*map, "info", "How large it is and where it lies", options);
  auto* const save = map->add_subcommand("save", "Write it to a file");
  save->add_option("FILE", options.file, "Ending in .bt, .ot, .ply, .pcd or .png")->required();
  auto* const config = app.add_subcommand("config", "Configuration")->require_subcommand(1);
  auto* const check = config->add_subcommand("check", "Tell all faults of a file");
  check->add_option("FILE", options.file)->required();
  auto* const print = config->add_subcommand("print", "Every key, of FILE or of the daemon");
  print->add_option("FILE", options.file);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return ExitCommand{app.exit(error) == 0 ? 0 : kUsageError};
  }
  if (status->parsed()) return StatusCommand{options.json};
  if (info->parsed()) return MapInfoCommand{options.json};
  if (save->parsed()) return MapSaveCommand{options.file};
  if (check->parsed()) return ConfigCheckCommand{options.file};
  return ConfigPrintCommand{options.file};
}

}  // namespace

CtlArguments parse_command_line(int argc, char** argv) {
  CLI::App app("Asks a running warrend.");
  Options options;
  app.add_option("--socket", options.socket, "Control socket of the daemon")->capture_default_str();
  app.set_version_flag("--version", std::string("warrenctl ") + WARREN_VERSION);
  app.require_subcommand(1);
  CtlCommand command = parse(app, options, argc, argv);
  return {options.socket, std::move(command)};
}

}  // namespace warren
