// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/peers_cli.hpp"

#include <CLI/CLI.hpp>

namespace warren {
namespace {

void add_tape(CLI::App& app, FleetTapeOptions& tape) {
  app.add_option("--tape-s", tape.seconds, "of a robot's drive that all of them play")
      ->check(CLI::Range(1.0, 600.0))
      ->capture_default_str();
  app.add_option("--tick-s", tape.tick_s, "between publishing ticks")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  app.add_option("--columns", tape.columns, "of the lidar with 64 beams")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--lidar-rate", tape.scan_hz, "Hz")
      ->check(CLI::Range(0.1, 50.0))
      ->capture_default_str();
  app.add_option("--resolution", tape.resolution_m, "edge of a voxel, m")
      ->check(CLI::Range(0.02, 1.0))
      ->capture_default_str();
  app.add_option("--max-range", tape.max_range_m, "m")
      ->check(CLI::Range(1.0, 100.0))
      ->capture_default_str();
  app.add_option("--seed", tape.seed, "of the cave")->capture_default_str();
  app.add_option("--length", tape.length_m, "of the cave, m")
      ->check(CLI::Range(50.0, 10000.0))
      ->capture_default_str();
}

}  // namespace

void add_options(CLI::App& app, PeersCommand& command) {
  PeersOptions& options = command.options;
  app.add_option("--robots", options.robots)->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--seconds", options.seconds, "that they publish")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--base", options.bases, "ADDRESS:PORT of the daemons that are to get all")
      ->required()
      ->delimiter(',');
  app.add_option("--key", options.key_file, "the fleet's key file")->required();
  app.add_option("--interface", options.interface)->capture_default_str();
  app.add_option("--port-base", options.port_base, "first of two UDP ports for each robot")
      ->check(CLI::Range(1024, 63000))
      ->capture_default_str();
  app.add_option("--settle-s", options.settle_s, "at most so long for what is missing at the end")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  add_tape(app, options.tape);
  app.add_flag("--json", command.json, "one JSON object instead of text");
}

}  // namespace warren
