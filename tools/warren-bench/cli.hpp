// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "tools/warren-bench/integrate.hpp"
#include "tools/warren-bench/map_quality.hpp"
#include "tools/warren-bench/peers_bench.hpp"
#include "tools/warren-bench/pipeline_bench.hpp"
#include "tools/warren-bench/terrain_quality.hpp"
#include "tools/warren-bench/transport_bench.hpp"
#include "tools/warren-bench/wire_bench.hpp"

namespace warren {

struct IntegrateCommand {
  SequenceSource source;
  IntegrateOptions options;
  std::optional<double> max_range_m;
  bool json = false;
};
struct MapQualityCommand {
  MapQualityOptions options;
  bool json = false;
};
struct TerrainCommand {
  SequenceSource source;
  std::optional<double> max_range_m;
  bool json = false;
};
struct PipelineCommand {
  SequenceSource source;
  PipelineOptions options;
  std::optional<double> max_range_m;
  bool json = false;
};
struct TerrainQualityCommand {
  TerrainQualityOptions options;
  bool json = false;
};
struct WireCommand {
  SequenceSource source;
  WireOptions options;
  std::optional<double> max_range_m;
  bool json = false;
};
struct TransportCommand {
  TransportOptions options;
  bool json = false;
};
struct PeersCommand {
  PeersOptions options;
  bool json = false;
};
struct ExitCommand {  // help was printed (0), or the line was wrong (2)
  int code = 0;
};

using Command = std::variant<IntegrateCommand, MapQualityCommand, TerrainCommand, PipelineCommand,
                             TerrainQualityCommand, TransportCommand, TransportPeerOptions,
                             WireCommand, PeersCommand, ExitCommand>;
Command parse_command_line(int argc, char** argv);

}  // namespace warren
