// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <csignal>
#include <iostream>
#include <numbers>

#include "daemon/config_commands.hpp"
#include "daemon/key_file.hpp"
#include "tools/warrenctl/ask.hpp"
#include "tools/warrenctl/cli.hpp"
#include "tools/warrenctl/failure.hpp"
#include "tools/warrenctl/fleet_table.hpp"
#include "tools/warrenctl/fleet_watch.hpp"
#include "tools/warrenctl/layer_watch.hpp"
#include "tools/warrenctl/loaded_layer.hpp"
#include "tools/warrenctl/tables.hpp"
#include "warren/control.pb.h"

namespace {

using namespace warren;

constexpr int kExitFailure = 1;

// Asks, then shows what `show` makes of the response.
template <typename Show>
int ask_and_show(const std::string& socket, const control::Request& request, const Show& show) {
  const auto response = ask_daemon(socket, request);
  if (!response) return failure(response.error(), kExitFailure);
  std::cout << show(*response);
  return 0;
}

control::Request request_of(const GroundCommand& command) {
  control::Request request;
  auto& ground = *request.mutable_ground();
  for (const double coordinate : command.position_map_m) ground.add_t_map_base(coordinate);
  const double half_yaw_rad = command.yaw_deg * std::numbers::pi / 360.0;
  const std::array<double, 4> by_yaw{0.0, 0.0, std::sin(half_yaw_rad), std::cos(half_yaw_rad)};
  for (const double q : command.rotation.value_or(by_yaw)) ground.add_t_map_base(q);
  ground.set_length_m(command.length_m);
  ground.set_width_m(command.width_m);
  ground.set_stair_capable(command.stair_capable);
  ground.set_source(command.on_merge ? control::MERGE : control::SELF);
  ground.set_unknown_up_to(command.unknown_up_to);
  if (command.above_m) ground.set_above_m(*command.above_m);
  if (command.below_m) ground.set_below_m(*command.below_m);
  return request;
}

control::Request request_of(const CellsCommand& command) {
  control::Request request;
  auto& cells = *request.mutable_cells();
  const auto& corners = command.corners_map_m;
  cells.mutable_low_map_m()->Assign(corners.begin(), corners.begin() + 3);
  cells.mutable_high_map_m()->Assign(corners.begin() + 3, corners.end());
  cells.set_source(command.on_merge ? control::MERGE : control::SELF);
  if (command.depth) cells.set_depth(*command.depth);
  if (command.cell_m) cells.set_cell_m(*command.cell_m);
  return request;
}

control::PictureColours colours_of(const std::string& name) {
  if (name == "cost") return control::COST;
  return name == "robot" ? control::ROBOT : control::HEIGHT;
}

struct Executor {
  const std::string& socket;

  int operator()(const StatusCommand& command) const {
    control::Request request;
    request.mutable_status();
    return ask_and_show(socket, request, [&](const control::Response& response) {
      return command.json ? json_of(response.status()) : table_of(response.status());
    });
  }
  int operator()(const MapInfoCommand& command) const {
    control::Request request;
    request.mutable_map_info();
    return ask_and_show(socket, request, [&](const control::Response& response) {
      return command.json ? json_of(response.map_info()) : table_of(response.map_info());
    });
  }
  int operator()(const MapSaveCommand& command) const {
    control::Request request;
    // The daemon's working directory is another one.
    request.mutable_map_save()->set_path(std::filesystem::absolute(command.file).string());
    request.mutable_map_save()->set_colours(colours_of(command.colours));
    if (command.of_merge) request.mutable_map_save()->set_source(control::MERGE);
    request.mutable_map_save()->set_of(command.of);
    return ask_and_show(socket, request, [](const control::Response& response) {
      return sentence_of(response.map_saved());
    });
  }
  int operator()(const MapLoadCommand& command) const {
    control::Request request;
    request.mutable_map_load()->set_path(std::filesystem::absolute(command.file).string());
    return ask_and_show(socket, request, [&](const control::Response& response) {
      return sentence_of(response.map_loaded());
    });
  }
  int operator()(const MapRetractCommand& command) const {
    return ask_about_layer(command.layer,
                           [](const control::LayerId& id, control::Request& request) {
                             *request.mutable_map_retract()->mutable_layer() = id;
                           });
  }
  int operator()(const MapRestoreCommand& command) const {
    return ask_about_layer(command.layer,
                           [](const control::LayerId& id, control::Request& request) {
                             *request.mutable_map_restore()->mutable_layer() = id;
                           });
  }
  int operator()(const MapMoveCommand& command) const {
    return ask_about_layer(command.layer,
                           [&](const control::LayerId& id, control::Request& request) {
                             auto& move = *request.mutable_map_move();
                             *move.mutable_layer() = id;
                             move.set_x_m(command.shift_fleet_m[0]);
                             move.set_y_m(command.shift_fleet_m[1]);
                             move.set_z_m(command.shift_fleet_m[2]);
                             move.set_yaw_rad(command.yaw_deg * std::numbers::pi / 180.0);
                           });
  }
  int operator()(const GroundCommand& command) const {
    return ask_and_show(socket, request_of(command), [&](const control::Response& response) {
      return command.json ? json_of(response.ground()) : table_of(response.ground());
    });
  }
  int operator()(const CellsCommand& command) const {
    return ask_and_show(socket, request_of(command), [&](const control::Response& response) {
      return command.json ? json_of(response.cells()) : table_of(response.cells());
    });
  }
  int operator()(const RayCommand& command) const {
    return ask_and_show(socket, request_of(command), [&](const control::Response& response) {
      return command.json ? json_of(response.rays()) : sentence_of(response.rays());
    });
  }
  int operator()(const ConfigCheckCommand& command) const {
    return check_config_command(command.file);
  }
  int operator()(const ConfigPrintCommand& command) const {
    if (!command.file.empty()) return print_config_command(command.file);
    control::Request request;
    request.mutable_config_print();
    return ask_and_show(socket, request,
                        [](const control::Response& response) { return response.config().yaml(); });
  }
  int operator()(const LayerExportCommand& command) const { return run(command); }
  int operator()(const LayerImportCommand& command) const { return run(command); }
  int operator()(const LayerDiffCommand& command) const { return run(command); }
  int operator()(const LayerDigestCommand& command) const { return run(command); }
  int operator()(const LayerWatchCommand& command) const { return run(command, socket); }
  int operator()(const LayerFlushCommand&) const {
    control::Request request;
    request.mutable_layer_flush();
    return ask_and_show(socket, request, [](const control::Response& response) {
      return sentence_of(response.layer_flushed());
    });
  }
  int operator()(const FleetStatusCommand& command) const {
    if (command.watch) return watch_fleet(command.json, socket);
    control::Request request;
    request.mutable_fleet_status();
    return ask_and_show(socket, request, [&](const control::Response& response) {
      const control::FleetStatus& status = response.fleet_status();
      return command.json ? json_of(status) : table_of(status);
    });
  }
  int operator()(const FleetCommand& command) const { return run(command, socket); }
  int operator()(const KeyNewCommand& command) const {
    const auto made = make_key_file(command.file);
    if (!made) return failure(made.error(), kExitFailure);
    std::cout << "wrote " << command.file.string()
              << ": copy it to every member of the fleet, for the daemon's user alone\n";
    return 0;
  }
  int operator()(const ExitCommand& command) const { return command.code; }

  template <typename Fill>
  int ask_about_layer(const std::string& name, const Fill& fill) const {
    const auto id = find_loaded_layer(socket, name);
    if (!id) return failure(id.error(), kExitFailure);
    control::Request request;
    fill(*id, request);
    return ask_and_show(socket, request, [](const control::Response& response) {
      return sentence_of(response.loaded_layer());
    });
  }
};

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  const CtlArguments arguments = parse_command_line(argc, argv);
  return std::visit(Executor{arguments.socket}, arguments.command);
}
