// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/cell.hpp"

#include <iomanip>
#include <iostream>

#include <doctest/doctest.h>

namespace warren::fleet_sim {
namespace {

CellUse show(const char* name, const Cell& cell) {
  const CellUse use = measure(cell);
  std::cout << std::fixed << std::setprecision(2) << std::setw(34) << name << " airtime "
            << use.airtime_share << ", bytes/voxel " << std::setprecision(3) << use.bytes_per_voxel
            << ", copies " << std::setprecision(2) << use.copies << ", telemetry "
            << use.telemetry_share << ", fresh " << use.fresh_share << ", backlog "
            << use.backlog_share << ", group " << use.group_share << ", lost wishes/min "
            << use.wishes << ", lag s " << use.lag_s_p50 << " / " << use.lag_s_p95 << std::endl;
  return use;
}

TEST_CASE("ten robots in one cell of 1 Mbit/s: to each, or to all at once") {
  for (const double loss : {0.0, 0.05, 0.2, 0.4}) {
    std::cout << "loss " << loss << "\n";
    Cell cell{.loss = loss};
    const CellUse unicast = show("to each", cell);
    cell.broadcast = true;
    const CellUse broadcast = show("to all at once", cell);
    CHECK(broadcast.bytes_per_voxel < unicast.bytes_per_voxel);
  }
}

TEST_CASE("ten robots that map much in one cell of 1 Mbit/s") {
  Cell cell{.loss = 0.05, .walker = {.blocks_per_step = 60, .voxels_per_block = 60}};
  cell.time = std::chrono::seconds(15);
  cell.broadcast = true;
  const CellUse broadcast = show("much, to all at once", cell);
  cell.broadcast = false;
  const CellUse unicast = show("much, to each", cell);
  CHECK(broadcast.lag_s_p95 < unicast.lag_s_p95);
}

TEST_CASE("what goes to all follows what the channel carries, not what little a member is sent") {
  Cell cell{.loss = 0.05, .walker = {.blocks_per_step = 150, .voxels_per_block = 60}};
  cell.broadcast = true;
  const CellUse use = show("very much, to all at once", cell);
  CHECK(use.lag_s_p95 < 2.0);
  CHECK(use.airtime_share < 0.3);
}

TEST_CASE("one robot writes, nine copy") {
  Cell cell{.writers = 1, .loss = 0.05};
  const CellUse unicast = show("to each", cell);
  cell.broadcast = true;
  const CellUse broadcast = show("to all at once", cell);
  CHECK(broadcast.bytes_per_voxel < unicast.bytes_per_voxel);
  cell.broadcast = false;
  cell.line = true;
  const CellUse chain = show("a chain of ten", cell);
  CHECK(chain.copies < unicast.copies);
}

}  // namespace
}  // namespace warren::fleet_sim
