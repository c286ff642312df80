// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "core/layer/coded_block.hpp"

namespace warren {

struct FleetTapeOptions {
  double seconds = 30.0;  // that are recorded
  double tick_s = 1.0;
  std::uint32_t columns = 1024;  // of 64 beams
  double scan_hz = 10.0;
  double resolution_m = 0.1;
  double max_range_m = 20.0;
  std::uint64_t seed = 1;
  double length_m = 250.0;  // of the cave
};

// What a robot in the simulated cave would hand over at each tick.
struct FleetTape {
  struct Tick {
    std::vector<CodedBlock> blocks;
    Eigen::Vector3d position_layer = Eigen::Vector3d::Zero();  // of the sensor, metres
  };
  std::vector<Tick> ticks;
  double resolution_m = 0.1;
};

tl::expected<FleetTape, std::string> record_fleet_tape(const FleetTapeOptions& options);

// A tape from some tick on, without an end: when it has come to the last tick, it goes on with the
// first, as far to the east that nothing is told again of a place that was told before.
class TapePlay {
 public:
  // The tape must outlive this, and has a tick.
  TapePlay(const FleetTape& tape, std::size_t start);

  FleetTape::Tick next();
  // So many ticks can be had before the key space ends.
  std::size_t ticks_max() const;

 private:
  const FleetTape& tape_;
  std::size_t at_;
  std::int32_t lap_ = 0;
  std::int32_t blocks_per_lap_ = 0;  // whole regions
  std::int32_t highest_ = 0;         // block along x
};

}  // namespace warren
