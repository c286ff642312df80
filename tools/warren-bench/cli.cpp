// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/cli.hpp"

#include <CLI/CLI.hpp>

namespace warren {
namespace {

struct RawIntegrate {
  std::string clouds;
  std::string poses;
  std::string poses_format = "kitti";
  std::string sensor_model = "default";
  double max_range_m = 0.0;
  bool json = false;
  IntegrateOptions options;
  std::size_t most_scans = 0;
};

void add_options(CLI::App& app, RawIntegrate& raw) {
  app.add_option("--clouds", raw.clouds, "directory of clouds, or one")->required();
  app.add_option("--poses", raw.poses, "pose file (none: identity)");
  app.add_option("--poses-format", raw.poses_format, "kitti, tum or matrix4")
      ->check(CLI::IsMember({"kitti", "tum", "matrix4"}));
  app.add_option("--resolution", raw.options.map.resolution_m, "edge of a voxel, m")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  app.add_option("--max-range", raw.max_range_m, "m; 0: no limit")
      ->check(CLI::Range(0.0, 1e4))
      ->capture_default_str();
  app.add_option("--sensor-model", raw.sensor_model, "default (OctoMap's) or field")
      ->check(CLI::IsMember({"default", "field"}))
      ->capture_default_str();
  app.add_flag("--one-ray-per-end-voxel", raw.options.map.one_ray_per_end_voxel,
               "both sides with one ray per end voxel (OctoMap's discretize)");
  app.add_option("--scans", raw.most_scans, "at most so many; 0: all")->capture_default_str();
  app.add_option("--growth-copies", raw.options.growth_copies,
                 "also measure our cost in a map of so many copies of the scene")
      ->check(CLI::Range(0, 24))
      ->capture_default_str();
  app.add_flag("--json", raw.json, "one JSON object instead of text");
}

IntegrateArguments resolve(const RawIntegrate& raw) {
  IntegrateArguments arguments;
  arguments.source.clouds = raw.clouds;
  if (!raw.poses.empty()) arguments.source.poses = raw.poses;
  arguments.source.poses_format = *pose_format_of(raw.poses_format);
  arguments.source.most_scans = raw.most_scans;
  arguments.options = raw.options;
  if (raw.sensor_model == "field") arguments.options.map.sensor_model = SensorModel::field();
  if (raw.max_range_m > 0.0) arguments.max_range_m = raw.max_range_m;
  arguments.json = raw.json;
  return arguments;
}

}  // namespace

CommandLine parse_command_line(int argc, char** argv) {
  CLI::App app("Warren's benchmarks: ours beside the named peer, same run, same input");
  app.require_subcommand(1);
  RawIntegrate raw;
  CLI::App* const integrate = app.add_subcommand("integrate", "scans into a map, beside OctoMap");
  add_options(*integrate, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error) == 0 ? 0 : 2};
  }
  return {resolve(raw), 0};
}

}  // namespace warren
