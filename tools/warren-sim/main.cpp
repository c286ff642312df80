// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "tools/warren-replay/progress.hpp"
#include "tools/warren-sim/cli.hpp"
#include "tools/warren-sim/picture.hpp"
#include "tools/warren-sim/record.hpp"
#include "tools/world/radio_trace.hpp"
#include "tools/world/truth/write_truth.hpp"

namespace {

using namespace warren;
using namespace warren::world;

std::atomic<bool> g_stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

int fail(const std::string& why) {
  std::fprintf(stderr, "warren-sim: %s\n", why.c_str());
  return 1;
}

void say(const World& world, double cpu_s) {
  fmt::print(
      stderr,
      "world {}, seed {}: {} triangles, {:.0f} m of passages, {} stairways, made in {:.1f} s\n",
      world.name, world.seed, world.mesh.triangles.size(), world.passages.length_m(),
      world.stairways.size(), cpu_s);
}

void show_count(std::size_t done, std::size_t all) {
  if (isatty(fileno(stderr)) == 0 && done != all) return;
  fmt::print(stderr, "\r{}/{} sweeps{}", done, all, done == all ? "\n" : "");
}

int execute(const RecordCommand& command, const World& world) {
  const Simulation simulation(world, make_simulation_spec(command.scenario));
  const std::filesystem::path out = command.out;
  const auto recorded = record(simulation, out, show_count);
  if (!recorded) return fail(recorded.error());
  fmt::print(
      stderr, "cast in {:.1f} ms CPU per sweep\n",
      1e3 * recorded->cast_cpu_s / static_cast<double>(std::max<std::size_t>(1, recorded->sweeps)));
  const auto written = write_truth(out / "truth", simulation, command.truth);
  return written ? 0 : fail(written.error());
}

int execute(const RunCommand& command, const World& world) {
  const Simulation simulation(world, make_simulation_spec(command.scenario));
  ProgressView view(stderr);
  const auto summary = run_live(
      simulation, command.live, [&](const ReplaySummary& now) { view.show(now); }, g_stop);
  if (!summary) return fail(summary.error());
  view.finish(*summary);
  std::fputs((command.json ? to_json(*summary) : to_text(*summary)).c_str(), stdout);
  if (!summary->error.empty()) return fail(summary->error);
  return summary->complete() ? 0 : 1;
}

int execute(const RenderCommand& command, const World& world) {
  std::filesystem::create_directories(command.out);
  const auto rendered = render(world, command.out);
  return rendered ? 0 : fail(rendered.error());
}

// The base station stands at the start; robots are where their routes take them.
std::vector<RadioNode> radio_nodes(const Simulation& simulation) {
  std::vector<RadioNode> nodes = {
      {"base", [start = simulation.world().start](double) { return start; }}};
  for (std::size_t i = 0; i < simulation.spec().robots.size(); ++i) {
    nodes.push_back({simulation.spec().robots[i].name, [&simulation, i](double time_s) {
                       return simulation.motion(i).T_world_base(time_s).translation().eval();
                     }});
  }
  return nodes;
}

int execute(const RadioCommand& command, const World& world) {
  const Simulation simulation(world, make_simulation_spec(command.scenario));
  std::filesystem::create_directories(command.out);
  const std::filesystem::path path = std::filesystem::path(command.out) / "radio.csv";
  std::ofstream file(path);
  RadioTrace trace;
  trace.end_s = command.scenario.duration_s;
  trace.step_s = command.step_s;
  trace.seed = command.scenario.world.seed;
  write_radio_trace(file, radio_nodes(simulation), passage_tiles(world.passages), RadioModel{},
                    trace);
  return file.flush() ? 0 : fail("cannot write " + path.string());
}

template <typename WorldCommand>
int execute(const WorldCommand& command) {
  const std::clock_t before = std::clock();
  const auto world = make_world(command.scenario);
  if (!world) return fail(world.error());
  say(*world, static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
  return execute(command, *world);
}

int execute(const WorldsCommand&) {
  for (const std::string& name : preset_names()) fmt::print("{}\n", name);
  return 0;
}

int execute(const ExitCommand& command) { return command.code; }

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, [](int) { g_stop = true; });
  std::signal(SIGTERM, [](int) { g_stop = true; });
  try {
    return std::visit([](const auto& command) { return execute(command); },
                      parse_command_line(argc, argv));
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(error.what());
  }
}
