// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/warrenctl/fleet_commands.hpp"
#include "tools/warrenctl/layer_commands.hpp"
#include "tools/warrenctl/ray_command.hpp"

namespace warren {

struct StatusCommand {
  bool json = false;
};
struct MapInfoCommand {
  bool json = false;
};
struct MapSaveCommand {
  std::filesystem::path file;
  std::string colours = "height";  // of a picture: height, cost, robot
  bool of_merge = false;
  std::string of{};  // another node's name
};
struct FleetStatusCommand {
  bool json = false;
  bool watch = false;  // again every second
};
struct KeyNewCommand {
  std::filesystem::path file;
};
struct MapLoadCommand {
  std::filesystem::path file;
};
// LAYER is the beginning of a layer's id as status shows it, the file of a loaded one, or the name
// of the node that writes it.
struct MapRetractCommand {
  std::string layer;
};
struct MapRestoreCommand {
  std::string layer;
};
struct MapMoveCommand {
  std::string layer;
  std::array<double, 3> shift_fleet_m{};
  double yaw_deg = 0.0;
};
struct GroundCommand {
  bool on_merge = false;
  std::array<double, 3> position_map_m{};
  double yaw_deg = 0.0;
  std::optional<std::array<double, 4>> rotation;  // qx qy qz qw; none: by yaw
  double length_m = 1.0;
  double width_m = 0.7;
  std::optional<double> above_m;
  std::optional<double> below_m;
  bool stair_capable = false;
  double unknown_up_to = 0.0;
  bool json = false;
};
struct CellsCommand {
  bool on_merge = false;
  std::vector<double> corners_map_m;  // x y z of a point, or of a box's two corners
  std::optional<std::uint32_t> depth;
  std::optional<double> cell_m;
  bool json = false;
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
using CtlCommand =
    std::variant<StatusCommand, MapInfoCommand, MapSaveCommand, GroundCommand, ConfigCheckCommand,
                 ConfigPrintCommand, LayerExportCommand, LayerImportCommand, LayerDiffCommand,
                 LayerDigestCommand, LayerWatchCommand, LayerFlushCommand, MapLoadCommand,
                 MapRetractCommand, MapRestoreCommand, MapMoveCommand, CellsCommand,
                 FleetStatusCommand, FleetCommand, KeyNewCommand, RayCommand, ExitCommand>;

struct CtlArguments {
  std::string socket;
  CtlCommand command;
};

CtlArguments parse_command_line(int argc, char** argv);

}  // namespace warren
