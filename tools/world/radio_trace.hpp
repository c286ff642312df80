// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tools/world/radio.hpp"
#include "tools/world/tile_graph.hpp"

namespace warren::world {

struct RadioNode {
  std::string name;
  std::function<Eigen::Vector3d(double time_s)> position;
};

struct RadioTrace {
  double start_s = 0.0;
  double end_s = 60.0;
  double step_s = 1.0;              // fading stands still as long
  std::size_t packet_bytes = 1200;  // that `loss` is meant for
  std::uint64_t seed = 1;
};

// How well every node hears every other, over time: CSV with a header, rows by time, then from,
// then to. Both directions of a link are alike. The model has no latency of its own. The same
// arguments give the same bytes.
void write_radio_trace(std::ostream& out, const std::vector<RadioNode>& nodes,
                       const RadioTiles& tiles, const RadioModel& model, const RadioTrace& trace);

}  // namespace warren::world
