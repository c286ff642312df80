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
  std::string colours = "height";
  GroundCommand ground;
};

CLI::App* add_with_json(CLI::App& app, const char* name, const char* text, Options& options) {
  auto* const command = app.add_subcommand(name, text);
  command->add_flag("--json", options.json, "One JSON object instead of a table");
  return command;
}

CLI::App* add_query(CLI::App& app, Options& options) {
  auto* const query =
      app.add_subcommand("query", "Ask about places in the map")->require_subcommand(1);
  auto* const command = add_with_json(
      *query, "ground", "The ground under a footprint, and may a robot stand there", options);
  GroundCommand& ground = options.ground;
  command->add_option("POSITION", ground.position_map_m, "x y z of the base on the ground, map, m")
      ->required();
  auto* const yaw = command->add_option("--yaw", ground.yaw_deg, "Heading, degrees about z");
  command->add_option("--rotation", ground.rotation, "The whole rotation: qx qy qz qw")
      ->excludes(yaw);
  command->add_option("--length", ground.length_m, "Of the footprint, along the base's x axis, m")
      ->capture_default_str();
  command->add_option("--width", ground.width_m, "Of the footprint, m")->capture_default_str();
  command->add_option("--above", ground.above_m, "Look from so far above the base (0.3), m");
  command->add_option("--below", ground.below_m, "To so far below it (0.7), m");
  command->add_flag("--stair-capable", ground.stair_capable, "The robot can climb stairs");
  return command;
}

CtlCommand parse(CLI::App& app, Options& options, int argc, char** argv) {
  auto* const status = add_with_json(app, "status", "What the daemon takes and drops", options);
  auto* const map = app.add_subcommand("map", "The map of this robot")->require_subcommand(1);
  auto* const info = add_with_json(*map, "info", "How large it is and where it lies", options);
  auto* const save = map->add_subcommand("save", "Write it to a file");
  save->add_option("FILE", options.file, "Ending in .bt, .ot, .ply, .pcd or .png")->required();
  save->add_option("--colours", options.colours, "Of a .png: height, or cost of the ground")
      ->check(CLI::IsMember({"height", "cost"}))
      ->capture_default_str();
  auto* const ground = add_query(app, options);
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
  if (save->parsed()) return MapSaveCommand{options.file, options.colours == "cost"};
  if (ground->parsed()) {
    options.ground.json = options.json;
    return options.ground;
  }
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
