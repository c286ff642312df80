// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/cli.hpp"

#include <CLI/CLI.hpp>

#include "tools/warren-bench/peers_cli.hpp"
#include "tools/warren-bench/transport_cli.hpp"

namespace warren {
namespace {

struct RawSource {
  std::string clouds;
  std::string poses;
  std::string poses_format = "kitti";
  double max_range_m = 0.0;
  std::size_t most_scans = 0;
};

struct RawMap {
  std::string sensor_model = "default";
  SelfMapConfig config;
};

struct RawIntegrate {
  RawSource source;
  RawMap map;
  int growth_copies = 0;
  bool json = false;
};

struct RawPipeline {
  RawSource source;
  RawMap map;
  std::string profile = PipelineOptions{}.profile;
  bool json = false;
};

struct RawWire {
  RawSource source;
  RawMap map;
  WireOptions options;
  bool json = false;
};

struct RawTerrain {
  RawSource source;
  bool json = false;
};

struct RawMapQuality {
  MapQualityCommand command;
  std::vector<double> custom;  // hit, miss, minimum, maximum
};

struct RawTerrainQuality {
  TerrainQualityCommand command;
  std::vector<std::string> vehicles = world::vehicle_names();
};

void add_source(CLI::App& app, RawSource& raw, const char* max_range_help) {
  app.add_option("--clouds", raw.clouds, "directory of clouds, or one")->required();
  app.add_option("--poses", raw.poses, "pose file (none: identity)");
  app.add_option("--poses-format", raw.poses_format, "kitti, tum or matrix4")
      ->check(CLI::IsMember({"kitti", "tum", "matrix4"}));
  app.add_option("--max-range", raw.max_range_m, max_range_help)
      ->check(CLI::Range(0.0, 1e4))
      ->capture_default_str();
  app.add_option("--scans", raw.most_scans, "at most so many; 0: all")->capture_default_str();
}

void add_map(CLI::App& app, RawMap& raw) {
  app.add_option("--resolution", raw.config.resolution_m, "edge of a voxel, m")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  app.add_option("--sensor-model", raw.sensor_model, "default (OctoMap's) or field")
      ->check(CLI::IsMember({"default", "field"}))
      ->capture_default_str();
  app.add_flag("--one-ray-per-end-voxel", raw.config.one_ray_per_end_voxel,
               "both sides with one ray per end voxel (OctoMap's discretize)");
}

void add_options(CLI::App& app, RawPipeline& raw) {
  add_source(app, raw.source, "m; 0: no limit");
  add_map(app, raw.map);
  app.add_option("--profile", raw.profile, "of the terrain: paper or robust")
      ->check(CLI::IsMember({"paper", "robust"}))
      ->capture_default_str();
  app.add_flag("--json", raw.json, "one JSON object instead of text");
}

void add_options(CLI::App& app, RawIntegrate& raw) {
  add_source(app, raw.source, "m; 0: no limit");
  add_map(app, raw.map);
  app.add_option("--growth-copies", raw.growth_copies,
                 "also measure our cost in a map of so many copies of the scene")
      ->check(CLI::Range(0, 24))
      ->capture_default_str();
  app.add_flag("--json", raw.json, "one JSON object instead of text");
}

void add_options(CLI::App& app, RawWire& raw) {
  add_source(app, raw.source, "m; 0: no limit");
  add_map(app, raw.map);
  app.add_option("--tick", raw.options.tick_s, "between publishing ticks, s")
      ->check(CLI::Range(0.01, 1e4))
      ->capture_default_str();
  app.add_option("--rate", raw.options.rate_hz, "of the scans, if poses carry no time")
      ->check(CLI::Range(0.001, 1e4))
      ->capture_default_str();
  app.add_option("--growth-copies", raw.options.growth_copies,
                 "also measure publishing and applying in a map of so many copies of the scene")
      ->check(CLI::Range(0, 24))
      ->capture_default_str();
  app.add_flag("--json", raw.json, "one JSON object instead of text");
}

void add_options(CLI::App& app, RawTerrain& raw) {
  add_source(app, raw.source, "m; points beyond are left out; 0: no limit");
  app.add_flag("--json", raw.json, "one JSON object instead of text");
}

void add_options(CLI::App& app, RawMapQuality& raw) {
  MapQualityOptions& options = raw.command.options;
  app.add_option("--worlds", options.worlds, "presets")->delimiter(',')->capture_default_str();
  app.add_option("--resolutions", options.resolutions_m, "edges of a voxel, m")
      ->delimiter(',')
      ->check(CLI::Range(0.02, 1.0))
      ->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("--seconds", options.duration_s, "that the robot explores")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--max-range", options.max_range_m, "m")
      ->check(CLI::Range(1.0, 100.0))
      ->capture_default_str();
  app.add_option("--custom", raw.custom,
                 "one more sensor model: HIT,MISS,MINIMUM,MAXIMUM as probabilities")
      ->delimiter(',')
      ->expected(4);
  app.add_flag("--json", raw.command.json, "one JSON object instead of text");
}

void add_options(CLI::App& app, RawTerrainQuality& raw) {
  TerrainQualityOptions& options = raw.command.options;
  app.add_option("--worlds", options.worlds, "presets")->delimiter(',')->capture_default_str();
  app.add_option("--vehicles", raw.vehicles, "whose bodies are tried")
      ->delimiter(',')
      ->check(CLI::IsMember(world::vehicle_names()))
      ->capture_default_str();
  app.add_option("--seed", options.run.seed)->capture_default_str();
  app.add_option("--seconds", options.run.duration_s, "that the robot explores")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--spacing", options.run.place_spacing_m, "of the places judged, m")
      ->check(CLI::Range(0.05, 5.0))
      ->capture_default_str();
  app.add_flag("--json", raw.command.json, "one JSON object instead of text");
}

SequenceSource source_of(const RawSource& raw) {
  SequenceSource source;
  source.clouds = raw.clouds;
  if (!raw.poses.empty()) source.poses = raw.poses;
  source.poses_format = *pose_format_of(raw.poses_format);
  source.most_scans = raw.most_scans;
  return source;
}

std::optional<double> max_range_of(const RawSource& raw) {
  return raw.max_range_m > 0.0 ? std::optional(raw.max_range_m) : std::nullopt;
}

SelfMapConfig map_config_of(const RawMap& raw) {
  SelfMapConfig config = raw.config;
  config.sensor_model =
      raw.sensor_model == "field" ? SensorModel::field() : SensorModel::octomap_default();
  return config;
}

IntegrateCommand resolve(const RawIntegrate& raw) {
  return {source_of(raw.source),
          {map_config_of(raw.map), raw.growth_copies},
          max_range_of(raw.source),
          raw.json};
}

PipelineCommand resolve(const RawPipeline& raw) {
  return {source_of(raw.source),
          {map_config_of(raw.map), raw.profile},
          max_range_of(raw.source),
          raw.json};
}

WireCommand resolve(const RawWire& raw) {
  WireOptions options = raw.options;
  options.map = map_config_of(raw.map);
  return {source_of(raw.source), options, max_range_of(raw.source), raw.json};
}

TerrainCommand resolve(const RawTerrain& raw) {
  return {source_of(raw.source), max_range_of(raw.source), raw.json};
}

MapQualityCommand resolve(const RawMapQuality& raw) {
  MapQualityCommand command = raw.command;
  command.options.models = {{"default", SensorModel::octomap_default()},
                            {"field", SensorModel::field()},
                            {"ours", SensorModel::ours()}};
  if (!raw.custom.empty()) {
    command.options.models.push_back(
        {"custom", {raw.custom[0], raw.custom[1], raw.custom[2], raw.custom[3]}});
  }
  return command;
}

TerrainQualityCommand resolve(const RawTerrainQuality& raw) {
  TerrainQualityCommand command = raw.command;
  command.options.run.vehicles.clear();
  for (const std::string& name : raw.vehicles) {
    command.options.run.vehicles.push_back(*world::vehicle_of(name));
  }
  return command;
}

}  // namespace

Command parse_command_line(int argc, char** argv) {
  CLI::App app("Warren's benchmarks: ours beside the named peer, same run, same input");
  app.require_subcommand(1);
  RawIntegrate integrate;
  RawMapQuality map_quality;
  RawTerrain terrain;
  RawPipeline pipeline;
  RawTerrainQuality terrain_quality;
  RawWire wire;
  TransportCommand transport;
  TransportPeerOptions transport_peer;
  PeersCommand peers;
  CLI::App* const integrate_app =
      app.add_subcommand("integrate", "scans into a map, beside OctoMap");
  CLI::App* const map_quality_app =
      app.add_subcommand("map-quality", "maps of simulated worlds against the truth");
  CLI::App* const terrain_app =
      app.add_subcommand("terrain", "scans into costs of the ground, beside PCL");
  CLI::App* const pipeline_app = app.add_subcommand(
      "pipeline", "scans into a map with costs, beside PCL and OctoMap together");
  CLI::App* const terrain_quality_app = app.add_subcommand(
      "terrain-quality", "costs of the ground against what vehicles can do in simulated worlds");
  CLI::App* const transport_app = app.add_subcommand(
      "transport", "a payload over an emulated radio link, beside TCP, ENet and SRT");
  CLI::App* const transport_peer_app = app.add_subcommand("transport-peer");
  CLI::App* const wire_app =
      app.add_subcommand("wire", "diff-maps into packets, beside other encodings and OctoMap");
  CLI::App* const peers_app =
      app.add_subcommand("peers", "many robots in one process, to load a base with");
  add_options(*integrate_app, integrate);
  add_options(*map_quality_app, map_quality);
  add_options(*terrain_app, terrain);
  add_options(*pipeline_app, pipeline);
  add_options(*terrain_quality_app, terrain_quality);
  add_options(*wire_app, wire);
  add_options(*transport_app, transport);
  add_options(*transport_peer_app, transport_peer);
  add_options(*peers_app, peers);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return ExitCommand{app.exit(error) == 0 ? 0 : 2};
  }
  if (map_quality_app->parsed()) return resolve(map_quality);
  if (terrain_app->parsed()) return resolve(terrain);
  if (pipeline_app->parsed()) return resolve(pipeline);
  if (terrain_quality_app->parsed()) return resolve(terrain_quality);
  if (wire_app->parsed()) return resolve(wire);
  if (transport_app->parsed()) return transport;
  if (transport_peer_app->parsed()) return transport_peer;
  if (peers_app->parsed()) return peers;
  return resolve(integrate);
}

}  // namespace warren
