// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "tools/warren-bench/cli.hpp"
#include "tools/warren-bench/terrain_bench.hpp"

namespace {

using namespace warren;

// Only the layer's origin is snapped by it.
constexpr double kTerrainLayerResolutionM = 0.1;

int fail(const std::string& why) {
  std::fprintf(stderr, "warren-bench: %s\n", why.c_str());
  return 2;
}

int print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  return 0;
}

int execute(const IntegrateCommand& command) {
  const auto sequence =
      load_sequence(command.source, command.options.map.resolution_m, command.max_range_m);
  if (!sequence) return fail(sequence.error());
  const auto result = bench_integrate(*sequence, command.options);
  return print(command.json ? to_json(result, command.options, command.max_range_m) + "\n"
                            : to_text(result));
}

int execute(const MapQualityCommand& command) {
  for (const NamedModel& model : command.options.models) {
    if (!model.model.is_valid())
      return fail("no sensor model: 0 < minimum, miss < 0.5 < hit, maximum < 1");
  }
  const auto results = bench_map_quality(command.options);
  if (!results) return fail(results.error());
  return print(command.json ? to_json(*results, command.options) + "\n" : to_text(*results));
}

int execute(const TerrainCommand& command) {
  auto sequence = load_sequence(command.source, kTerrainLayerResolutionM, command.max_range_m);
  if (!sequence) return fail(sequence.error());
  sequence->leave_out_beyond_max_range();
  const auto result = bench_terrain(*sequence);
  return print(command.json ? to_json(result) + "\n" : to_text(result));
}

int execute(const PipelineCommand& command) {
  const auto sequence =
      load_sequence(command.source, command.options.map.resolution_m, command.max_range_m);
  if (!sequence) return fail(sequence.error());
  const auto result = bench_pipeline(*sequence, command.options);
  return print(command.json ? to_json(result, command.options, command.max_range_m) + "\n"
                            : to_text(result));
}

int execute(const TerrainQualityCommand& command) {
  const auto results = bench_terrain_quality(command.options);
  if (!results) return fail(results.error());
  return print(command.json ? to_json(*results, command.options) + "\n" : to_text(*results));
}

int execute(const WireCommand& command) {
  const auto sequence =
      load_sequence(command.source, command.options.map.resolution_m, command.max_range_m);
  if (!sequence) return fail(sequence.error());
  const auto result = bench_wire(*sequence, command.options);
  if (!result) return fail(result.error());
  return print(command.json ? to_json(*result, command.options, command.max_range_m) + "\n"
                            : to_text(*result));
}

int execute(const TransportCommand& command) {
  const auto results = bench_transport(command.options);
  if (!results) return fail(results.error());
  return print(command.json ? to_json(*results, command.options) + "\n"
                            : to_text(*results, command.options));
}

int execute(const TransportPeerOptions& options) { return run_transport_peer(options); }

int execute(const PeersCommand& command) {
  const auto result = bench_peers(command.options);
  if (!result) return fail(result.error());
  print(command.json ? to_json(*result, command.options) + "\n" : to_text(*result));
  const bool arrived = result->digests_equal == command.options.robots;
  return arrived ? 0 : 1;
}

int execute(const ExitCommand& command) { return command.code; }

}  // namespace

int main(int argc, char** argv) {
  return std::visit([](const auto& command) { return execute(command); },
                    parse_command_line(argc, argv));
}
