// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-train-priors/cli.hpp"

#include <CLI/CLI.hpp>

#include "tools/world/world.hpp"

namespace warren {

std::variant<TrainOptions, int> parse_command_line(int argc, char** argv) {
  TrainOptions options;
  CLI::App app(
      "Trains the probabilities that every diff packet starts from. Robots explore simulated\n"
      "worlds, publish at several tick lengths, with and without the sender rules, and whole; the\n"
      "bits of their packets are counted by context. Run from the top of the sources it writes\n"
      "the table that core/layer is built with. A new table is a new format: raise the packet's\n"
      "version, renew the golden bytes. The bytes it prints are those with the table built in:\n"
      "build and run again to see the gain.",
      "warren-train-priors");
  app.add_option("--worlds", options.worlds, "presets to explore")
      ->check(CLI::IsMember(world::preset_names()))
      ->capture_default_str();
  app.add_option("--seeds", options.seeds, "of each world; benchmarks use low ones")
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "in each world")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--clouds", options.clouds,
                 "clouds or directories of them, each cloud on its own, in its sensor's frame");
  app.add_option("--out", options.out, "the table")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return options;
}

}  // namespace warren
