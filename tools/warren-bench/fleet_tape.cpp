// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/fleet_tape.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "tools/warren-bench/wire_tape.hpp"
#include "tools/world/simulation.hpp"

namespace warren {
namespace {

constexpr std::int32_t kBlocksAlongRegion = kRegionEdge / kBlockEdge;
constexpr std::int32_t kBlockXMax = kKeyMax / kBlockEdge;

world::SimulationSpec simulation_spec(const FleetTapeOptions& options) {
  world::SimulationSpec spec;
  spec.seed = options.seed;
  spec.duration_s = options.seconds;
  world::RobotSpec& robot = spec.robots.emplace_back();
  robot.lidar.columns = options.columns;
  robot.lidar.rate_hz = options.scan_hz;
  return spec;
}

ScanSequence explore(const world::Simulation& simulation, const FleetTapeOptions& options) {
  ScanSequence sequence;
  sequence.max_range_m = options.max_range_m;
  SensorFilter filter;
  filter.max_range_m = options.max_range_m;
  ScanPreparer preparer;
  world::FrameStream frames(simulation, 0);
  while (auto frame = frames.next()) {
    Scan scan;
    scan.T_map_base = Pose::of(frame->T_map_base);
    scan.T_base_sensor = Pose::of(frame->T_base_sensor);
    scan.points_sensor = std::move(frame->points_sensor);
    const auto prepared =
        preparer.prepare(scan, filter, {}, options.resolution_m, sequence.rejected);
    if (!prepared) continue;
    sequence.scans.push_back({prepared->origin_layer,
                              {prepared->points_layer.begin(), prepared->points_layer.end()},
                              frame->time_s});
  }
  return sequence;
}

Eigen::Vector3d position_at(const ScanSequence& sequence, std::size_t scan) {
  const Point3f& origin = sequence.scans[std::min(scan, sequence.scans.size() - 1)].origin_layer;
  return {origin.x, origin.y, origin.z};
}

std::pair<std::int32_t, std::int32_t> reach_along_x(const FleetTape& tape) {
  std::int32_t low = std::numeric_limits<std::int32_t>::max();
  std::int32_t high = std::numeric_limits<std::int32_t>::min();
  for (const FleetTape::Tick& tick : tape.ticks) {
    for (const CodedBlock& block : tick.blocks) {
      const std::int32_t x = block_key_of(block.block).x;
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  return low <= high ? std::pair{low, high} : std::pair{0, 0};
}

}  // namespace

tl::expected<FleetTape, std::string> record_fleet_tape(const FleetTapeOptions& options) {
  const auto world = world::make_world({"cave", options.seed, options.length_m});
  if (!world) return tl::unexpected(world.error());
  const world::Simulation simulation(*world, simulation_spec(options));
  const ScanSequence sequence = explore(simulation, options);
  if (sequence.scans.empty()) return tl::unexpected(std::string("the tape would have no scan"));

  WireOptions wire;
  wire.map.resolution_m = options.resolution_m;
  wire.tick_s = options.tick_s;
  wire.rate_hz = options.scan_hz;
  WireTape recorded = record_wire_tape(sequence, wire);
  FleetTape tape;
  tape.resolution_m = options.resolution_m;
  for (std::size_t i = 0; i < recorded.ticks.size(); ++i) {
    const std::size_t last_scan = (i + 1) * recorded.scans_per_tick - 1;
    tape.ticks.push_back({std::move(recorded.ticks[i]), position_at(sequence, last_scan)});
  }
  return tape;
}

TapePlay::TapePlay(const FleetTape& tape, std::size_t start)
    : tape_(tape), at_(start % tape.ticks.size()) {
  const auto [low, high] = reach_along_x(tape);
  const std::int32_t regions = (high - low) / kBlocksAlongRegion + 1;
  blocks_per_lap_ = regions * kBlocksAlongRegion;
  highest_ = high;
}

std::size_t TapePlay::ticks_max() const {
  const std::int32_t laps = (kBlockXMax - highest_) / blocks_per_lap_ + 1;
  return static_cast<std::size_t>(laps) * tape_.ticks.size() - at_;
}

FleetTape::Tick TapePlay::next() {
  FleetTape::Tick tick = tape_.ticks[at_];
  const std::int32_t shift = lap_ * blocks_per_lap_;
  for (CodedBlock& block : tick.blocks) {
    BlockKey key = block_key_of(block.block);
    key.x += shift;
    assert(key.x <= kBlockXMax);
    block.block = ordinal_of(key);
  }
  tick.position_layer.x() += shift * kBlockEdge * tape_.resolution_m;
  if (++at_ == tape_.ticks.size()) {
    at_ = 0;
    ++lap_;
  }
  return tick;
}

}  // namespace warren
