// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-sim/cli.hpp"

#include <numbers>

#include <CLI/CLI.hpp>

namespace warren::world {
namespace {

constexpr std::uint32_t kMaxRobots = 100;

struct Raw {
  ScenarioOptions scenario;
  std::vector<std::string> placed;
  std::string out;
  std::string rate = "real";
  LiveOptions live;
  bool json = false;
  TruthOptions truth;
  double step_s = 1.0;
};

// FILE,X,Y,Z,YAW_DEG
std::optional<PlacedMesh> parse_placed(const std::string& text) {
  const auto parts = CLI::detail::split(text, ',');
  if (parts.size() != 5) return std::nullopt;
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!CLI::detail::lexical_cast(parts[i + 1], numbers[i])) return std::nullopt;
  }
  return PlacedMesh{
      parts[0], {numbers[0], numbers[1], numbers[2]}, numbers[3] * std::numbers::pi / 180.0};
}

std::string check_placed(const std::string& text) {
  return parse_placed(text) ? std::string() : "must be FILE,X,Y,Z,YAW_DEG: " + text;
}

void add_world(CLI::App& app, Raw& raw) {
  WorldSpec& world = raw.scenario.world;
  app.add_option("--world", world.preset, "preset")
      ->check(CLI::IsMember(preset_names()))
      ->capture_default_str();
  app.add_option("--seed", world.seed, "of the world and of all that happens in it")
      ->capture_default_str();
  app.add_option("--length", world.length_m, "of all passages, about, m; 0: the preset's own")
      ->check(CLI::Range(0.0, 20000.0))
      ->capture_default_str();
  app.add_option("--place", raw.placed, "put a mesh file into the world: FILE,X,Y,Z,YAW_DEG")
      ->check(CLI::Validator(check_placed, "FILE,X,Y,Z,YAW_DEG"));
}

void add_team(CLI::App& app, Raw& raw) {
  ScenarioOptions& o = raw.scenario;
  app.add_option("--seconds", o.duration_s)->check(CLI::Range(0.1, 36000.0))->capture_default_str();
  app.add_option("--robots", o.robots)->check(CLI::Range(1U, kMaxRobots))->capture_default_str();
  app.add_option("--stagger", o.stagger_s, "seconds between the robots' starts")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option("--speed", o.speed_m_s, "of the robots, m/s")
      ->check(CLI::Range(0.05, 5.0))
      ->capture_default_str();
  app.add_option("--vehicle", o.vehicle)
      ->check(CLI::IsMember(vehicle_names()))
      ->capture_default_str();
  app.add_option("--people", o.people, "who walk about")
      ->check(CLI::Range(0U, 100U))
      ->capture_default_str();
}

void add_sensing(CLI::App& app, Raw& raw) {
  ScenarioOptions& o = raw.scenario;
  app.add_option("--lidar", o.lidar)->check(CLI::IsMember(lidar_names()))->capture_default_str();
  app.add_option("--columns", o.columns, "per turn")
      ->check(CLI::Range(16U, 4096U))
      ->capture_default_str();
  app.add_option("--lidar-rate", o.rate_hz, "turns per second")
      ->check(CLI::Range(1.0, 20.0))
      ->capture_default_str();
  app.add_option("--tilt", o.sensor_tilt_deg, "of the lidar, nose down, degrees")
      ->check(CLI::Range(-90.0, 90.0))
      ->capture_default_str();
  app.add_flag("--skewed", o.skewed, "deliver points as measured, not moved to the sweep's end");
  app.add_option("--yaw-drift", o.yaw_drift_deg_m, "of the odometry, degrees per metre")
      ->capture_default_str();
  app.add_option("--scale-error", o.scale_error, "of the odometry, share of the way")
      ->capture_default_str();
  app.add_option("--pose-noise", o.pose_noise_m, "of the odometry, standard deviation, m")
      ->capture_default_str();
  app.add_option("--jump", o.jumps_s, "seconds at which the odometry jumps by 0.5 m and 3 degrees");
}

CLI::App* add_command(CLI::App& app, Raw& raw, const char* name, const char* help) {
  CLI::App* const command = app.add_subcommand(name, help);
  add_world(*command, raw);
  return command;
}

void add_run_options(CLI::App& run, Raw& raw) {
  run.add_option("--socket", raw.live.sockets, "ingest socket of each robot's daemon, in order")
      ->required();
  run.add_option("--sensor", raw.live.sensor, "name in the daemon's config (none: its first)");
  run.add_option("--frame-epoch", raw.live.frame_epoch, "number of the odometry's start")
      ->capture_default_str();
  run.add_option("--rate", raw.rate, "real time, or max: as fast as the scans are taken")
      ->check(CLI::IsMember({"real", "max"}))
      ->capture_default_str();
  run.add_flag("--json", raw.json, "summary as a JSON object");
}

ScenarioOptions scenario_of(const Raw& raw) {
  ScenarioOptions scenario = raw.scenario;
  for (const std::string& text : raw.placed) scenario.placed.push_back(*parse_placed(text));
  scenario.jumps_s = raw.scenario.jumps_s;
  std::sort(scenario.jumps_s.begin(), scenario.jumps_s.end());
  return scenario;
}

}  // namespace

Command parse_command_line(int argc, char** argv) {
  CLI::App app("Simulated worlds, and robots with lidars and radios in them");
  app.require_subcommand(1);
  Raw raw;
  CLI::App* const record = add_command(app, raw, "record", "write a recording and its truth");
  CLI::App* const run = add_command(app, raw, "run", "robots live into running daemons");
  CLI::App* const render = add_command(app, raw, "render", "pictures of a world");
  CLI::App* const radio = add_command(app, raw, "radio", "who hears whom, over time, as a trace");
  CLI::App* const worlds = app.add_subcommand("worlds", "list the presets");
  for (CLI::App* const command : {record, run, radio}) add_team(*command, raw);
  for (CLI::App* const command : {record, run}) add_sensing(*command, raw);
  for (CLI::App* const command : {record, render, radio}) {
    command->add_option("--out", raw.out, "directory; made if missing")->required();
  }
  record
      ->add_option("--drivability-spacing", raw.truth.drivability_spacing_m,
                   "of the ground points that vehicles are placed on, m; 0: none")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  radio->add_option("--step", raw.step_s, "of the trace, s")->check(CLI::Range(0.01, 60.0));
  add_run_options(*run, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return ExitCommand{app.exit(error) == 0 ? 0 : 2};
  }
  const ScenarioOptions scenario = scenario_of(raw);
  raw.live.real_time = raw.rate == "real";
  if (record->parsed()) return RecordCommand{scenario, raw.out, raw.truth};
  if (run->parsed()) return RunCommand{scenario, raw.live, raw.json};
  if (render->parsed()) return RenderCommand{scenario, raw.out};
  if (radio->parsed()) return RadioCommand{scenario, raw.out, raw.step_s};
  return worlds->parsed() ? Command{WorldsCommand{}} : Command{ExitCommand{2}};
}

}  // namespace warren::world
