// SPDX-License-Identifier: Apache-2.0
#include "tools/world/radio_trace.hpp"

#include <algorithm>
#include <cassert>
#include <cstdio>

namespace warren::world {
namespace {

// Each link fades by itself, so that a node more does not change the others' fading.
Random fading_of(std::uint64_t seed, std::size_t one, std::size_t other, std::uint64_t step) {
  const auto [low, high] = std::minmax(one, other);
  return Random(seed).fork(low).fork(high).fork(step);
}

void write_row(std::ostream& out, double time_s, const std::string& from, const std::string& to,
               const RadioState& state) {
  char numbers[64];
  std::snprintf(numbers, sizeof(numbers), "%.3f", time_s);
  out << numbers << ',' << from << ',' << to;
  std::snprintf(numbers, sizeof(numbers), ",%.6f,%.0f\n", state.loss, state.rate_bit_s);
  out << numbers;
}

}  // namespace

void write_radio_trace(std::ostream& out, const std::vector<RadioNode>& nodes,
                       const RadioTiles& tiles, const RadioModel& model, const RadioTrace& trace) {
  assert(trace.step_s > 0.0);
  out << "time_s,from,to,loss,rate_bit_s\n";
  for (std::uint64_t step = 0;; ++step) {
    const double time_s = trace.start_s + trace.step_s * static_cast<double>(step);
    if (time_s > trace.end_s) return;
    for (std::size_t from = 0; from < nodes.size(); ++from)
      for (std::size_t to = 0; to < nodes.size(); ++to) {
        if (from == to) continue;
        const Eigen::Vector3d here = nodes[from].position(time_s);
        const Eigen::Vector3d there = nodes[to].position(time_s);
        const RadioLink link{.distance_m = (there - here).norm(), .cost = tiles.cost(here, there)};
        Random fading = fading_of(trace.seed, from, to, step);
        write_row(out, time_s, nodes[from].name, nodes[to].name,
                  radio_state(model, link, trace.packet_bytes, fading));
      }
  }
}

}  // namespace warren::world
