// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/cli.hpp"

#include <optional>

#include <CLI/CLI.hpp>

#include "tools/warrenctl/fleet_cli.hpp"

namespace warren {
namespace {

constexpr int kUsageError = 2;

struct Options {
  std::string socket = "/run/warren/control.sock";
  bool json = false;
  bool merge = false;
  bool watch = false;
  std::string of;
  std::string file;
  std::string colours = "height";
  std::string layer;
  std::array<double, 4> shift{};  // x y z yaw
  GroundCommand ground;
  CellsCommand cells;
  RayCommand ray;
  std::string other_file;
  std::uint32_t origin = 0;
  bool regions = false;
  int seconds = 1'000'000;
};

CLI::App* add_with_json(CLI::App& app, const char* name, const char* text, Options& options) {
  auto* const command = app.add_subcommand(name, text);
  command->add_flag("--json", options.json, "One JSON object instead of a table");
  return command;
}

// `query point` or `query box`.
CLI::App* add_cells(CLI::App& query, const char* name, const char* text, const char* place,
                    const char* place_text, int numbers, Options& options) {
  auto* const command = add_with_json(query, name, text, options);
  CellsCommand& cells = options.cells;
  command->add_option(place, cells.corners_map_m, place_text)->required()->expected(numbers);
  auto* const depth =
      command->add_option("--depth", cells.depth, "Of the octree: 16 a voxel, 0 all keys")
          ->check(CLI::Range(0, 16));
  command->add_option("--cell-m", cells.cell_m, "The smallest cells with at least this edge, m")
      ->excludes(depth);
  command->add_flag("--merge", cells.on_merge, "On the merge-map: what others know counts too");
  return command;
}

CLI::App* add_ground(CLI::App& query, Options& options) {
  auto* const command = add_with_json(
      query, "ground", "The ground under a footprint, and may a robot stand there", options);
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
  command->add_flag("--merge", ground.on_merge, "On the merge-map: what others know counts too");
  command->add_flag("--stair-capable", ground.stair_capable, "The robot can climb stairs");
  command
      ->add_option("--unknown-up-to", ground.unknown_up_to,
                   "Share of the footprint whose cost may be unknown")
      ->check(CLI::Range(0.0, 1.0));
  return command;
}

CLI::App* add_ray(CLI::App& query, Options& options) {
  auto* const command = add_with_json(query, "ray", "What a ray meets first", options);
  RayCommand& ray = options.ray;
  command->add_option("RAY", ray.ray_map, "x y z of its origin, map, m; x y z of its direction")
      ->required();
  command->add_option("--max-range", ray.max_range_m, "Look so far, m")->capture_default_str();
  command->add_flag("--merge", ray.on_merge, "On the merge-map: what others know counts too");
  command->add_flag("--through-unknown", ray.through_unknown, "Only what is occupied stops it");
  return command;
}

// The commands on the map; afterwards, which one was given.
class MapCommands {
 public:
  MapCommands(CLI::App& app, Options& options) : options_(options) {
    auto* const map = app.add_subcommand("map", "The map of this robot")->require_subcommand(1);
    info_ = add_with_json(*map, "info", "How large it is and where it lies", options);
    save_ = map->add_subcommand("save", "Write it to a file");
    save_->add_option("FILE", options.file, "Ending in .bt, .ot, .ply, .pcd, .png or .layer")
        ->required();
    save_
        ->add_option("--colours", options.colours,
                     "Of a .png: height, cost of the ground, or robot")
        ->check(CLI::IsMember({"height", "cost", "robot"}))
        ->capture_default_str();
    auto* const merge =
        save_->add_flag("--merge", options.merge, "The merge-map: what others know counts too");
    save_
        ->add_option("--of", options.of,
                     "Another node: its newest layer as it is copied here; or merge")
        ->excludes(merge);
    load_ = map->add_subcommand("load", "Put a layer of an earlier mission into the merge-map");
    load_->add_option("FILE", options.file, "Ending in .layer, .bt or .ot")->required();
    retract_ = add_on_layer(*map, "retract", "Take a loaded layer out of this node's merge-map");
    restore_ = add_on_layer(*map, "restore", "Put it back");
    move_ = add_on_layer(*map, "move", "Shift and turn a loaded layer in this node's merge-map");
    move_
        ->add_option("SHIFT", options.shift,
                     "x y z, metres of the fleet frame, and yaw, degrees about the layer's origin; "
                     "in place of an earlier move: 0 0 0 0 undoes it")
        ->required();
  }

  std::optional<CtlCommand> parsed() const {
    const Options& given = options_;
    const auto& [x_m, y_m, z_m, yaw_deg] = given.shift;
    if (info_->parsed()) return MapInfoCommand{given.json};
    if (save_->parsed()) {
      const bool of_merge = given.merge || given.of == "merge";
      return MapSaveCommand{given.file, given.colours, of_merge, of_merge ? "" : given.of};
    }
    if (load_->parsed()) return MapLoadCommand{given.file};
    if (retract_->parsed()) return MapRetractCommand{given.layer};
    if (restore_->parsed()) return MapRestoreCommand{given.layer};
    if (move_->parsed()) return MapMoveCommand{given.layer, {x_m, y_m, z_m}, yaw_deg};
    return std::nullopt;
  }

 private:
  CLI::App* add_on_layer(CLI::App& map, const char* name, const char* text) {
    auto* const command = map.add_subcommand(name, text);
    command
        ->add_option("LAYER", options_.layer,
                     "Its file, the name of the node that writes it, or the beginning of its id")
        ->required();
    return command;
  }

  Options& options_;
  CLI::App* info_ = nullptr;
  CLI::App* save_ = nullptr;
  CLI::App* load_ = nullptr;
  CLI::App* retract_ = nullptr;
  CLI::App* restore_ = nullptr;
  CLI::App* move_ = nullptr;
};

// The commands on layer files; afterwards, which one was given.
class LayerCommands {
 public:
  LayerCommands(CLI::App& app, Options& options) : options_(options) {
    auto* const layer =
        app.add_subcommand("layer", "Layers, of files and of the daemon")->require_subcommand(1);
    export_ = layer->add_subcommand("export", "Write a layer as a tree or a cloud");
    add_files(*export_, "LAYER", "FILE", "Ending in .bt, .ot, .ply or .pcd");
    import_ = layer->add_subcommand("import", "Make a layer of an OctoMap tree");
    add_files(*import_, "TREE", "LAYER", "The layer file to write");
    import_->add_option("--origin", options.origin, "Number of the node it counts as")
        ->capture_default_str();
    diff_ = add_with_json(*layer, "diff", "Count voxels that differ; exit code as diff's", options);
    add_files(*diff_, "A", "B", "The layer to compare with");
    digest_ = layer->add_subcommand("digest", "The hash that equal layers share");
    digest_->add_option("LAYER", options.file)->required();
    digest_->add_flag("--regions", options.regions,
                      "And of each region, with the key of its lowest voxel");
    watch_ = layer->add_subcommand("watch", "The bytes per second of the daemon's diff-maps");
    watch_->add_option("--seconds", options.seconds, "Stop after so long, or when the daemon does")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    flush_ = layer->add_subcommand("flush", "Publish at once what the sender rules hold back");
  }

  std::optional<CtlCommand> parsed() const {
    const Options& given = options_;
    if (export_->parsed()) return LayerExportCommand{given.file, given.other_file};
    if (import_->parsed()) {
      return LayerImportCommand{given.file, given.other_file, given.origin};
    }
    if (diff_->parsed()) return LayerDiffCommand{given.file, given.other_file, given.json};
    if (digest_->parsed()) return LayerDigestCommand{given.file, given.regions};
    if (flush_->parsed()) return LayerFlushCommand{};
    if (watch_->parsed()) return LayerWatchCommand{given.seconds};
    return std::nullopt;
  }

 private:
  void add_files(CLI::App& command, const char* first, const char* second, const char* text) {
    command.add_option(first, options_.file)->required();
    command.add_option(second, options_.other_file, text)->required();
  }

  Options& options_;
  CLI::App* export_ = nullptr;
  CLI::App* import_ = nullptr;
  CLI::App* diff_ = nullptr;
  CLI::App* digest_ = nullptr;
  CLI::App* watch_ = nullptr;
  CLI::App* flush_ = nullptr;
};

CtlCommand parse(CLI::App& app, Options& options, int argc, char** argv) {
  auto* const status = add_with_json(app, "status", "What the daemon takes and drops", options);
  const MapCommands map(app, options);
  auto* const query =
      app.add_subcommand("query", "Ask about places in the map")->require_subcommand(1);
  auto* const ground = add_ground(*query, options);
  auto* const point = add_cells(*query, "point", "The code of the cell around a point", "POSITION",
                                "x y z, map, m", 3, options);
  auto* const box = add_cells(*query, "box", "The codes of all cells that a box touches", "CORNERS",
                              "Lowest x y z, highest x y z, map, m", 6, options);
  auto* const ray = add_ray(*query, options);
  auto* const config = app.add_subcommand("config", "Configuration")->require_subcommand(1);
  auto* const check = config->add_subcommand("check", "Tell all faults of a file");
  check->add_option("FILE", options.file)->required();
  auto* const print = config->add_subcommand("print", "Every key, of FILE or of the daemon");
  print->add_option("FILE", options.file);
  const LayerCommands layer(app, options);
  auto* const fleet = app.add_subcommand("fleet", "The fleet")->require_subcommand(1);
  auto* const fleet_status = add_with_json(
      *fleet, "status", "Who is there, and how far their maps have come here", options);
  fleet_status->add_flag("--watch", options.watch,
                         "Again every second, also after the daemon has restarted");
  FleetCli fleet_cli(app, *fleet);
  auto* const key = app.add_subcommand("key", "The fleet's key")->require_subcommand(1);
  auto* const key_new = key->add_subcommand("new", "Make one; every member needs a copy of it");
  key_new->add_option("FILE", options.file)->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return ExitCommand{app.exit(error) == 0 ? 0 : kUsageError};
  }
  if (status->parsed()) return StatusCommand{options.json};
  if (const auto command = map.parsed()) return *command;
  if (ground->parsed()) {
    options.ground.json = options.json;
    return options.ground;
  }
  if (point->parsed() || box->parsed()) {
    options.cells.json = options.json;
    return options.cells;
  }
  if (ray->parsed()) {
    options.ray.json = options.json;
    return options.ray;
  }
  if (const auto command = layer.parsed()) return *command;
  if (fleet_status->parsed()) return FleetStatusCommand{options.json, options.watch};
  if (const auto command = fleet_cli.parsed()) return *command;
  if (key_new->parsed()) return KeyNewCommand{options.file};
  if (check->parsed()) return ConfigCheckCommand{options.file};
  return ConfigPrintCommand{options.file};
}

}  // namespace

CtlArguments parse_command_line(int argc, char** argv) {
  CLI::App app("Asks a running warrend, and works on layer files.");
  Options options;
  app.add_option("--socket", options.socket, "Control socket of the daemon")->capture_default_str();
  app.set_version_flag("--version", std::string("warrenctl ") + WARREN_VERSION);
  app.require_subcommand(1);
  CtlCommand command = parse(app, options, argc, argv);
  return {options.socket, std::move(command)};
}

}  // namespace warren
