// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/layer/coded_block.hpp"
#include "core/voxel/self_map.hpp"
#include "tools/warren-bench/scan_sequence.hpp"

namespace warren {

struct WireOptions {
  SelfMapConfig map;
  double tick_s = 10.0;
  double rate_hz = 1.0;  // of the scans, where they carry no time
  std::size_t packet_bytes = 1200;
  int growth_copies = 0;  // 0: do not measure
};

// What a robot that mapped the sequence would hand over at each tick: the exact codes of the blocks
// that changed. Terrain by TerrainConfig::paper().
struct WireTape {
  std::vector<std::vector<CodedBlock>> ticks;
  std::size_t scans_per_tick = 0;
  // CPU of publishing every ten scans, sender rules on, over that of integrating them.
  double publish_share = 0.0;
};

WireTape record_wire_tape(const ScanSequence& sequence, const WireOptions& options);

// By the scans' own times if all have one, else by the rate given; at least one.
std::size_t scans_per_tick(const ScanSequence& sequence, const WireOptions& options);

}  // namespace warren
