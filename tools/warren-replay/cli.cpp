// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-replay/cli.hpp"

#include <cmath>

#include <CLI/CLI.hpp>

namespace warren {
namespace {

struct Raw {
  std::string clouds;
  std::string poses;
  std::string poses_format = "kitti";
  std::vector<double> gravity = {0.0, 0.0, -1.0};
  std::string rate = "10";
  std::string socket = "/run/warren/ingest.sock";
  std::string sensor;
  std::uint64_t frame_epoch = 1;
  bool json = false;
};

std::string check_rate(const std::string& text) {
  if (text == "max") return {};
  double rate_hz = 0.0;
  const bool number = CLI::detail::lexical_cast(text, rate_hz);
  return number && rate_hz > 0.0 && rate_hz <= 1000.0
             ? std::string()
             : "must be a number of Hz above 0 and up to 1000, or max: " + text;
}

void add_options(CLI::App& app, Raw& raw) {
  app.add_option("--clouds", raw.clouds,
                 "a cloud, or a directory of them: .pcd .ply .bin .txt .xyz")
      ->required();
  app.add_option("--poses", raw.poses, "T_map_sensor of each cloud (none: identity)");
  app.add_option("--poses-format", raw.poses_format, "kitti, tum or matrix4")
      ->check(CLI::IsMember({"kitti", "tum", "matrix4"}))
      ->capture_default_str();
  app.add_option("--gravity", raw.gravity, "direction of gravity in the map frame: X,Y,Z")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--rate", raw.rate, "scans per second, or max: as fast as they are taken")
      ->check(CLI::Validator(check_rate, "HZ|max"))
      ->capture_default_str();
  app.add_option("--socket", raw.socket, "the daemon's ingest socket")->capture_default_str();
  app.add_option("--sensor", raw.sensor, "name in the daemon's config (none: its first)");
  app.add_option("--frame-epoch", raw.frame_epoch, "number of the odometry's start")
      ->capture_default_str();
  app.add_flag("--json", raw.json, "summary as a JSON object");
}

ReplayArguments resolve(const Raw& raw) {
  ReplayArguments arguments;
  arguments.clouds = raw.clouds;
  if (!raw.poses.empty()) arguments.poses = raw.poses;
  arguments.poses_format = *pose_format_of(raw.poses_format);
  arguments.gravity_map = {raw.gravity[0], raw.gravity[1], raw.gravity[2]};
  arguments.socket = raw.socket;
  arguments.json = raw.json;
  arguments.options.sensor = raw.sensor;
  arguments.options.frame_epoch = raw.frame_epoch;
  arguments.options.rate_hz.reset();
  if (raw.rate != "max") arguments.options.rate_hz = std::stod(raw.rate);
  return arguments;
}

}  // namespace

ReplayCommandLine parse_command_line(int argc, char** argv) {
  CLI::App app("Sends a recorded lidar sequence to a running warrend");
  Raw raw;
  add_options(app, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error) == 0 ? 0 : 2};
  }
  return {resolve(raw), 0};
}

}  // namespace warren
