// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-link/report.hpp"

#include <nlohmann/json.hpp>

namespace warren {
namespace {

using Json = nlohmann::ordered_json;

double milliseconds(Duration time) { return static_cast<double>(time.count()) / 1000.0; }

Json link_json(std::size_t from, std::size_t to, const LinkCounts& counts) {
  return {{"from", from},
          {"to", to},
          {"offered_packets", counts.offered_packets},
          {"offered_bytes", counts.offered_bytes},
          {"delivered_packets", counts.delivered_packets},
          {"delivered_bytes", counts.delivered_bytes},
          {"dropped",
           {{"too_large", counts.dropped_too_large},
            {"queue_full", counts.dropped_queue_full},
            {"blackout", counts.dropped_blackout},
            {"loss", counts.dropped_loss},
            {"burst", counts.dropped_burst},
            {"pattern", counts.dropped_pattern}}},
          {"duplicated", counts.duplicated},
          {"corrupted", counts.corrupted},
          {"reordered", counts.reordered}};
}

}  // namespace

std::string to_json(const Emulator& emulator, const Namespaces& namespaces, Duration ran) {
  const LinkModel& model = emulator.model();
  const Lateness& late = emulator.lateness();
  const double mean =
      late.packets == 0 ? 0.0 : milliseconds(late.sum) / static_cast<double>(late.packets);
  Json report{{"seconds", milliseconds(ran) / 1000.0},
              {"late_ms", {{"mean", mean}, {"max", milliseconds(late.max)}}},
              {"nodes", Json::array()},
              {"links", Json::array()}};
  for (std::size_t node = 0; node < model.stations(); ++node) {
    const StationCounts& counts = model.counts(static_cast<StationIndex>(node));
    report["nodes"].push_back({{"namespace", namespaces.name(node)},
                               {"sent_packets", counts.sent_packets},
                               {"sent_bytes", counts.sent_bytes},
                               {"queue_ms_max", milliseconds(counts.queue_time_max)},
                               {"read_errors", emulator.errors(node).read},
                               {"write_errors", emulator.errors(node).write}});
  }
  for (std::size_t from = 0; from < model.stations(); ++from) {
    for (std::size_t to = 0; to < model.stations(); ++to) {
      const LinkCounts& counts =
          model.counts(static_cast<StationIndex>(from), static_cast<StationIndex>(to));
      if (counts.offered_packets > 0) report["links"].push_back(link_json(from, to, counts));
    }
  }
  return report.dump();
}

}  // namespace warren
